// What the small triangles of a tile cover, taken into its visibility.
#include <algorithm>

#include "zoneplate/raster/tile.h"

namespace zoneplate {

void TileRenderer::draw_fragments() {
  const auto first = static_cast<std::uint32_t>(first_sample_ * tile_pixels);
  const auto values = static_cast<std::uint32_t>(pass_samples_ * tile_pixels);
  float* const depth = visibility_.depth;
  std::int32_t* const id = visibility_.id;
  for (const Bins::Worker& worker : bins_.workers)
    for (const SampleFragments* part = worker.fragments[tile_]; part; part = part->previous)
      for (std::int32_t i = 0; i < part->count; ++i) {
        const std::uint32_t at = part->at[i] - first;
        if (at >= values) continue;  // of another pass
        const auto block = static_cast<int>(at % tile_pixels / (8 * tile_size) * 8 + at % tile_size / 8);
        if (visibility_.block_owner[block] == no_triangle) visibility_.open_block(block);
        const float z = part->depth[i];
        if (z < depth[at] || (z == depth[at] && part->id[i] > id[at])) continue;
        visibility_.block_owner[block] = many_triangles;
        depth[at] = z;
        id[at] = part->id[i];
      }
}

bool TileRenderer::has_fragments() const {
  return std::any_of(bins_.workers.begin(), bins_.workers.end(),
                     [&](const Bins::Worker& worker) { return worker.fragments[tile_]; });
}

}  // namespace zoneplate
