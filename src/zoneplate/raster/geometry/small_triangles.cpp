// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/small_triangles.h"

#include <algorithm>

#include "zoneplate/raster/geometry/setup.h"
#include "zoneplate/raster/types/tile_grid.h"

namespace zoneplate::scalar {
namespace {

/// The bounds of a triangle, 1/256 pixel from the image's top-left corner.
struct Bounds {
  std::int32_t low_x, high_x, low_y, high_y;
};

Bounds bounds_of(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, Viewport viewport) {
  const std::int32_t cx = viewport.width * 128, cy = viewport.height * 128;
  return {std::min({p.x, q.x, r.x}) + cx, std::max({p.x, q.x, r.x}) + cx, std::min({p.y, q.y, r.y}) + cy,
          std::max({p.y, q.y, r.y}) + cy};
}

bool may_cover_a_sample(const Bounds& b, const SmallTriangleRun& run) {
  for (int s = 0; s < run.sample_count; ++s) {
    const std::int32_t sx = run.sample_x[s], sy = run.sample_y[s];
    if ((b.low_x - sx + 255) >> 8 <= (b.high_x - sx) >> 8 && (b.low_y - sy + 255) >> 8 <= (b.high_y - sy) >> 8)
      return true;
  }
  return false;
}

bool is_in_rectangle(const Bounds& b, const SmallTriangleRun& run) {
  return b.low_x >> 8 <= run.right && b.high_x >> 8 >= run.left && b.low_y >> 8 <= run.bottom &&
         b.high_y >> 8 >= run.top;
}

void put(const SmallTriangleRun& run, SampleBinWriter& sink, std::int32_t tile, float depth, std::int32_t id,
         std::uint32_t at) {
  SampleBin* part = sink.last[tile];
  const auto is_full = [&] {
    return part->count == SampleBin::capacity || id < part->first_id || id - part->first_id > 0xffff;
  };
  if (!part || is_full()) part = sink.grow(sink, tile, run.first_id);
  part->depth[part->count] = depth;
  part->packed[part->count++] = (static_cast<std::uint32_t>(id - part->first_id) << 16) + at;
}

void draw(const Triangle& t, const SmallTriangleRun& run, SampleBinWriter& sink) {
  SamplePosition samples[TileTriangle::max_samples];
  for (int s = 0; s < run.sample_count; ++s)
    samples[s] = {static_cast<std::uint8_t>(run.sample_x[s]), static_cast<std::uint8_t>(run.sample_y[s])};
  constexpr int last = tile_size - 1;
  for (int y = std::max(t.min_y, run.top & ~last); y <= std::min(t.max_y, run.bottom | last); ++y)
    for (int x = std::max(t.min_x, run.left & ~last); x <= std::min(t.max_x, run.right | last); ++x) {
      const int column = x / tile_size, row = y / tile_size, i = x % tile_size, j = y % tile_size;
      TileTriangle tile;
      make_tile_triangle(t, samples, run.sample_count, column * tile_size, row * tile_size, tile);
      for (int s = 0; s < run.sample_count; ++s) {
        bool is_covered = true;
        for (int k = 0; k < 3; ++k) is_covered = is_covered && tile.a[k] * i + tile.b[k] * j + tile.c[k][s] >= 0;
        if (is_covered)
          put(run, sink, (row - sink.first_row) * sink.columns + column - sink.first_column, depth_at(tile, s, i, j),
              t.id, static_cast<std::uint32_t>(s * tile_pixels + j * tile_size + i));
      }
    }
}

void run_front(const SmallTriangleRun& run, SampleBinWriter& sink, SmallTriangleResult& result) {
  result.deferred_count = result.visible_count = 0, result.drawn = 0;
  const RasterRules rules{.edge_rule = run.edge_rule};
  for (std::int32_t t = 0; t < run.count; ++t) {
    const ScreenVertex &p = run.screen[run.index[3 * t]], &q = run.screen[run.index[3 * t + 1]],
                       &r = run.screen[run.index[3 * t + 2]];
    const Bounds b = bounds_of(p, q, r, run.viewport);
    const std::int32_t width = b.high_x - b.low_x, height = b.high_y - b.low_y;
    if (p.inv_w == 0 || q.inv_w == 0 || r.inv_w == 0 || width > large_extent || height > large_extent) {
      result.deferred[result.deferred_count++] = t;
      continue;
    }
    const std::int64_t area = doubled_area(p, q, r);
    if (area == 0 || (run.facing != 0 && (area > 0) != (run.facing > 0))) continue;
    if (!may_cover_a_sample(b, run) || !is_in_rectangle(b, run)) continue;
    if (std::max(width, height) > run.small_extent) {
      if (run.records)
        run.records[result.visible_count++] = make_triangle(p, q, r, run.first_id + t, run.viewport, rules);
      else
        result.visible[result.visible_count++] = t;
      continue;
    }
    ++result.drawn;
    draw(make_triangle(p, q, r, run.first_id + t, run.viewport, rules), run, sink);
  }
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const SmallTriangleKernels PerIsa<SmallTriangleKernels>::scalar = {.run = scalar::run_front};

}  // namespace zoneplate
