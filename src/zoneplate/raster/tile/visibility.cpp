// A tile of which no colour is wanted: the owners of the samples, and how many of them each pixel has.
#include <bit>

#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

void TileRenderer::render_visibility() {
  begin_pass(0, static_cast<int>(target_.samples.size()));
  draw_opaque();
  draw_masked();
  visibility_.materialize_all();
  times_.visibility += watch_.lap_ms();
  store_visibility();
  times_.output += watch_.lap_ms();
}

/// The owners of the samples of this pass, and their depths.
void TileRenderer::store_visibility() {
  for (int s = 0; s < pass_samples_; ++s)
    for (int y = top_; y < bottom_; ++y)
      for (int x = left_; x < right_; ++x) {
        if (!is_wanted(x, y)) continue;
        const auto sample = static_cast<std::size_t>(s);
        const std::size_t at = sample * tile_pixels + static_cast<std::size_t>(y * tile_size + x);
        const int column = tile_x_ + x - target_.x, row = tile_y_ + y - target_.y;
        const std::int32_t id = visibility_.id[at];
        const auto number = static_cast<std::size_t>(first_sample_ + s);
        (*target_.sample_triangle)[number](column, row) =
            id == no_primitive ? Target::no_id : static_cast<std::uint32_t>(id);
        if (target_.sample_depth) (*target_.sample_depth)[number](column, row) = visibility_.depth[at];
      }
}

/// covered_: by the points of this pass.
void TileRenderer::count_covered() {
  for (const Fragment& point : points_) covered_[point.pixel] += static_cast<float>(std::popcount(point.samples));
}

}  // namespace zoneplate
