// A tile of which only the owners of the samples are wanted: nothing is shaded.
#include "zoneplate/raster/tile/tile.h"

namespace zoneplate {

void TileRenderer::render_visibility() {
  begin_pass(0, static_cast<int>(target_.samples.size()));
  draw_opaque();
  draw_masked();
  visibility_.materialize_all();
  times_.visibility += watch_.lap_ms();
  for (int s = 0; s < pass_samples_; ++s)
    for (int y = top_; y < bottom_; ++y)
      for (int x = left_; x < right_; ++x) {
        if (!is_wanted(x, y)) continue;
        const auto sample = static_cast<std::size_t>(s);
        const std::size_t at = sample * tile_pixels + static_cast<std::size_t>(y * tile_size + x);
        const int column = tile_x_ + x - target_.x, row = tile_y_ + y - target_.y;
        const std::int32_t id = visibility_.id[at];
        (*target_.sample_triangle)[sample](column, row) =
            id == no_primitive ? Target::no_id : static_cast<std::uint32_t>(id);
        if (target_.sample_depth) (*target_.sample_depth)[sample](column, row) = visibility_.depth[at];
      }
  times_.output += watch_.lap_ms();
}

}  // namespace zoneplate
