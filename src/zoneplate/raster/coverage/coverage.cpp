// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/coverage/coverage.h"

#include <algorithm>

namespace zoneplate {

void TileVisibility::clear() {
  std::fill_n(block_min_depth, blocks, 0.0f);
  std::fill_n(block_primitive, blocks, no_primitive);
  dirty = 0;
}

void TileVisibility::materialize_block(int block) {
  if (block_primitive[block] == no_primitive) {
    const int corner = block / 8 * 8 * tile_size + block % 8 * 8;
    for (int s = 0; s < sample_count; ++s)
      for (int y = 0; y < 8; ++y) {
        std::fill_n(depth + s * sample_stride + corner + y * tile_size, 8, 0.0f);
        std::fill_n(id + s * sample_stride + corner + y * tile_size, 8, no_primitive);
      }
  }
  block_primitive[block] = mixed_primitives;
}

void TileVisibility::materialize_all() {
  for (int block = 0; block < blocks; ++block)
    if (block_primitive[block] == no_primitive) materialize_block(block);
}

namespace scalar {
namespace {

bool covers(const TileTriangle& t, int s, int x, int y) {
  for (int k = 0; k < 3; ++k)
    if (t.a[k] * x + t.b[k] * y + t.c[k][s] < 0) return false;
  return true;
}

bool wins(const TileTriangle& t, const TileVisibility& tile, int s, int x, int y) {
  const int at = s * sample_stride + y * tile_size + x;
  const float z = depth_at(t, s, x, y);
  return covers(t, s, x, y) && (z > tile.depth[at] || (z == tile.depth[at] && t.id < tile.id[at]));
}

bool draw(const TileTriangle& t, TileVisibility& tile) {
  for (int y = t.first_y & ~7; y <= t.last_y; y += 8)
    for (int x = t.first_x & ~7; x <= t.last_x; x += 8) tile.materialize_block(y + x / 8);
  for (int s = 0; s < tile.sample_count; ++s)
    for (int y = t.first_y; y <= t.last_y; ++y)
      for (int x = t.first_x; x <= t.last_x; ++x)
        if (wins(t, tile, s, x, y)) {
          tile.depth[s * sample_stride + y * tile_size + x] = depth_at(t, s, x, y);
          tile.id[s * sample_stride + y * tile_size + x] = t.id;
        }
  return false;
}

int collect(const TileTriangle& t, const TileVisibility& tile, CoveredPixel* out) {
  int count = 0;
  for (int y = t.first_y; y <= t.last_y; ++y)
    for (int x = t.first_x; x <= t.last_x; ++x) {
      std::uint64_t samples = 0;
      for (int s = 0; s < tile.sample_count; ++s)
        if (wins(t, tile, s, x, y)) samples |= std::uint64_t{1} << s;
      if (samples) out[count++] = {samples, static_cast<std::uint32_t>(y * tile_size + x)};
    }
  return count;
}

int collect_rows(const TileTriangle& t, const TileVisibility& tile, std::uint64_t blocks, SpanLayer* out,
                 std::uint8_t* is_partial) {
  int count = 0;
  for (int y = t.first_y; y <= t.last_y; ++y)
    for (int bx = t.first_x & ~7; bx <= t.last_x; bx += 8) {
      if (!(blocks >> ((y & ~7) + bx / 8) & 1)) continue;
      SpanLayer layer{t.id, static_cast<std::uint32_t>(y * 8 + bx / 8), t.z_high, t.z_low};
      int won = 0;
      for (int s = 0; s < tile.sample_count; ++s)
        for (int x = bx; x < bx + 8; ++x) {
          if (!wins(t, tile, s, x, y)) continue;
          const float z = depth_at(t, s, x, y);
          layer.least = z < layer.least ? z : layer.least;
          layer.greatest = z > layer.greatest ? z : layer.greatest;
          ++won;
        }
      if (won == 8 * tile.sample_count)
        out[count++] = layer;
      else if (won > 0)
        is_partial[layer.row] = 1;
    }
  return count;
}

void compute_nearest(const TileVisibility& tile, float* nearest) {
  for (int block = 0; block < TileVisibility::blocks; ++block) {
    nearest[block] = 0;
    if (tile.block_primitive[block] == no_primitive) continue;
    for (int s = 0; s < tile.sample_count; ++s)
      for (int i = 0; i < 64; ++i) {
        const int y = block / 8 * 8 + i / 8, x = block % 8 * 8 + i % 8;
        nearest[block] = std::max(nearest[block], tile.depth[s * sample_stride + y * tile_size + x]);
      }
  }
}

int collect_blocks(const TileTriangle& t, const TileVisibility& tile, const float* nearest, BlockLayer* out,
                   std::uint64_t& others) {
  int count = 0;
  for (int by = t.first_y & ~7; by <= t.last_y; by += 8)
    for (int bx = t.first_x & ~7; bx <= t.last_x; bx += 8) {
      const int block = by + bx / 8;
      BlockLayer layer{t.id, static_cast<std::uint32_t>(block), t.z_high, t.z_low};
      int covered = 0;
      for (int s = 0; s < tile.sample_count; ++s)
        for (int i = 0; i < 64; ++i) {
          const int x = bx + i % 8, y = by + i / 8;
          covered += covers(t, s, x, y) ? 1 : 0;
          layer.least = std::min(layer.least, depth_at(t, s, x, y));
          layer.greatest = std::max(layer.greatest, depth_at(t, s, x, y));
        }
      if (covered == 64 * tile.sample_count && layer.least > nearest[block])
        out[count++] = layer;
      else if (covered > 0)
        others |= std::uint64_t{1} << block;
    }
  return count;
}

void fetch_owners(const TileVisibility& tile, std::int32_t* owners) {
  for (int row = 0; row < tile_pixels / 8; ++row) {
    owners[row] = tile.block_primitive[row / 64 * 8 + row % 8];
    if (owners[row] != mixed_primitives) continue;
    owners[row] = tile.id[row * 8];
    for (int s = 0; s < tile.sample_count; ++s)
      for (int x = 0; x < 8; ++x)
        if (tile.id[s * sample_stride + row * 8 + x] != tile.id[row * 8]) owners[row] = mixed_primitives;
  }
}

}  // namespace

}  // namespace scalar

template <>
const CoverageKernels PerIsa<CoverageKernels>::scalar = {.draw = scalar::draw,
                                                         .collect = scalar::collect,
                                                         .collect_rows = scalar::collect_rows,
                                                         .compute_nearest = scalar::compute_nearest,
                                                         .collect_blocks = scalar::collect_blocks,
                                                         .fetch_owners = scalar::fetch_owners};
}  // namespace zoneplate
