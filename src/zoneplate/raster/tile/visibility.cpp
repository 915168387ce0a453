// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/visibility.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "zoneplate/base/deadline.h"

namespace zoneplate {
namespace {

/// Materializes all blocks if the small triangles have enough samples to touch most blocks.
bool materialize_if_most(const TileJob& job, TileVisibility& visibility) {
  constexpr std::int32_t enough = 2048;
  std::int32_t count = 0;
  for (const Bins::Worker& worker : job.setup.bins.workers)
    for (const SampleBin* bin = worker.fragments[job.tile]; bin && count < enough; bin = bin->previous)
      count += bin->count;
  if (count < enough) return false;
  for (int block = 0; block < TileVisibility::blocks; ++block) {
    if (visibility.block_primitive[block] == no_primitive) visibility.materialize_block(block);
    visibility.block_primitive[block] = mixed_primitives;
  }
  return true;
}

/// Materializes the blocks of the bin's samples, which may have several visible primitives afterwards.
void materialize_touched(const SampleBin& bin, TileVisibility& visibility) {
  std::uint64_t touched = 0;
  for (std::int32_t i = 0; i < bin.count; ++i) {
    const std::uint32_t at = bin.packed[i];
    touched |= std::uint64_t{1} << ((at >> 6 & 56) + (at >> 3 & 7));
  }
  for (; touched; touched &= touched - 1) {
    const int block = std::countr_zero(touched);
    if (visibility.block_primitive[block] == no_primitive) visibility.materialize_block(block);
    visibility.block_primitive[block] = mixed_primitives;
  }
}

}  // namespace

VisibilityBuffer::VisibilityBuffer(int max_samples)
    : depth_storage_(static_cast<std::size_t>(max_samples) * sample_stride),
      id_storage_(static_cast<std::size_t>(max_samples) * sample_stride) {
  depth = depth_storage_.data();
  id = id_storage_.data();
  block_min_depth = block_min_depth_storage_;
  block_primitive = block_primitive_storage_;
}

void rasterize_opaque(const TileJob& job, TileVisibility& visibility) {
  visibility.sample_count = job.pass.count;
  visibility.clear();
  float* const block_depth = visibility.block_min_depth;
  for (int block = 0; block < TileVisibility::blocks; ++block)
    if (!job.overlaps_block(block)) block_depth[block] = std::numeric_limits<float>::infinity();
  float tile_min_depth = 0;  // no sample of the tile is below it
  std::size_t number = 0;
  TileTriangle triangle;
  for (const Triangle* t : job.triangles_of(AlphaMode::Opaque)) {
    if (++number % deadline_stride == 0) check_deadline();
    if (t->z_high < tile_min_depth) continue;
    job.make_triangle(*t, triangle);
    if (max_depth(triangle, job.pass.count) < tile_min_depth) continue;
    const bool has_risen = job.setup.coverage.draw(triangle, visibility);
    const bool is_large =
        triangle.last_x - triangle.first_x >= tile_size / 2 && triangle.last_y - triangle.first_y >= tile_size / 2;
    if (has_risen && is_large) tile_min_depth = *std::min_element(block_depth, block_depth + TileVisibility::blocks);
  }
  rasterize_small(job, visibility);
}

void rasterize_small(const TileJob& job, TileVisibility& visibility) {
  const auto first = static_cast<std::uint32_t>(job.pass.first * tile_pixels);
  const auto values = static_cast<std::uint32_t>(job.pass.count * tile_pixels);
  float* const depth = visibility.depth;
  std::int32_t* const id = visibility.id;
  const bool is_materialized = materialize_if_most(job, visibility);
  for (const Bins::Worker& worker : job.setup.bins.workers)
    for (const SampleBin* bin = worker.fragments[job.tile]; bin; bin = bin->previous) {
      if (!is_materialized) materialize_touched(*bin, visibility);
      for (std::int32_t i = 0; i < bin->count; ++i) {
        // The next bin was written long ago and has left the caches.
        if (i % 16 == 0 && bin->previous) {
          __builtin_prefetch(&bin->previous->depth[i]);
          __builtin_prefetch(&bin->previous->packed[i]);
        }
        const std::uint32_t value = SampleBin::at(bin->packed[i]) - first;
        if (value >= values) continue;  // a sample of another pass
        const std::uint32_t at = sample_place(value);
        const float z = bin->depth[i];
        const std::int32_t t = bin->id(bin->packed[i]);
        if (z < depth[at] || (z == depth[at] && t > id[at])) continue;
        depth[at] = z;
        id[at] = t;
      }
    }
}

void write_visibility(const TileJob& job, const TileVisibility& visibility) {
  const Target& target = job.setup.target;
  for (int s = 0; s < job.pass.count; ++s)
    for (int y = job.drawn.top; y < job.drawn.bottom; ++y)
      for (int x = job.drawn.left; x < job.drawn.right; ++x) {
        if (!job.draws(x, y)) continue;
        const auto sample = static_cast<std::size_t>(s);
        const auto pixel = static_cast<std::uint32_t>(y * tile_size + x);
        const std::size_t at = sample * sample_stride + pixel;
        const std::int32_t id = visibility.id[at];
        std::uint32_t& triangle = (*target.sample_triangle)[sample](job.target_x(pixel), job.target_y(pixel));
        if (target.keeps_nearer) {
          const bool is_nearer =
              triangle == Target::no_id ||
              visibility.depth[at] > (*target.sample_depth)[sample](job.target_x(pixel), job.target_y(pixel));
          if (id == no_primitive || !is_nearer) continue;
        }
        triangle = id == no_primitive ? Target::no_id : static_cast<std::uint32_t>(id);
        if (target.sample_depth)
          (*target.sample_depth)[sample](job.target_x(pixel), job.target_y(pixel)) = visibility.depth[at];
      }
}

}  // namespace zoneplate
