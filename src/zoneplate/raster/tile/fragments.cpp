// What the small triangles of a tile cover, taken into its visibility.
#include <algorithm>
#include <bit>

#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

void TileRenderer::draw_fragments() {
  const auto first = static_cast<std::uint32_t>(first_sample_ * tile_pixels);
  const auto values = static_cast<std::uint32_t>(pass_samples_ * tile_pixels);
  float* const depth = visibility_.depth;
  std::int32_t* const id = visibility_.id;
  const bool fills_blocks = materializes_most_blocks();
  for (const Bins::Worker& worker : bins_.workers)
    for (const SampleBin* part = worker.fragments[tile_]; part; part = part->previous) {
      if (!fills_blocks) materialize_blocks(*part);
      for (std::int32_t i = 0; i < part->count; ++i) {
        // What comes next was written long ago.
        if (i % 16 == 0 && part->previous) {
          __builtin_prefetch(&part->previous->depth[i]);
          __builtin_prefetch(&part->previous->what[i]);
        }
        const std::uint32_t at = SampleBin::at(part->what[i]) - first;
        if (at >= values) continue;  // of another pass
        const float z = part->depth[i];
        const std::int32_t t = part->id(part->what[i]);
        if (z < depth[at] || (z == depth[at] && t > id[at])) continue;
        depth[at] = z;
        id[at] = t;
      }
    }
}

/// Opens all blocks where there are so many fragments that most would be.
bool TileRenderer::materializes_most_blocks() {
  constexpr std::int32_t enough = 2048;
  std::int32_t count = 0;
  for (const Bins::Worker& worker : bins_.workers)
    for (const SampleBin* part = worker.fragments[tile_]; part && count < enough; part = part->previous)
      count += part->count;
  if (count < enough) return false;
  for (int block = 0; block < TileVisibility::blocks; ++block) {
    if (block_primitive_[block] == no_primitive) visibility_.materialize_block(block);
    block_primitive_[block] = mixed_primitives;
  }
  return true;
}

/// The blocks of these samples may have several owners then.
void TileRenderer::materialize_blocks(const SampleBin& part) {
  std::uint64_t touched = 0;
  for (std::int32_t i = 0; i < part.count; ++i) {
    const std::uint32_t at = part.what[i];
    touched |= std::uint64_t{1} << ((at >> 6 & 56) + (at >> 3 & 7));
  }
  for (; touched; touched &= touched - 1) {
    const int block = std::countr_zero(touched);
    if (visibility_.block_primitive[block] == no_primitive) visibility_.materialize_block(block);
    visibility_.block_primitive[block] = mixed_primitives;
  }
}

}  // namespace zoneplate
