// What the small triangles of a tile cover, taken into its visibility.
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
        const float z = part->depth[i];
        if (z < depth[at] || (z == depth[at] && part->id[i] > id[at])) continue;
        depth[at] = z;
        id[at] = part->id[i];
      }
}

}  // namespace zoneplate
