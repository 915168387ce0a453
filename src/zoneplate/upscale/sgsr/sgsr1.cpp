// SPDX-License-Identifier: Apache-2.0
// Snapdragon Game Super Resolution 1: a filter of twelve taps on green alone, which is longer along edges; its change
// is added to all channels of the bilinear image.
//
// Made for mobile GPUs: where the image is smooth it stays bilinear. Its input is to be antialiased. Weakness: only the
// left two of the four nearest pixels decide about an edge, so that some upright edges stay soft; coloured edges of
// equal green stay soft.
//
// Source: Qualcomm, snapdragon-gsr, sgsr/v1 (sgsr1_shader_mobile.frag), 2023, with UseEdgeDirection. Without it, the
// weights of that shader change sign within the support, and edges become noise.
#include <algorithm>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/upscale/alpha.h"
#include "zoneplate/upscale/axis.h"
#include "zoneplate/upscale/sgsr/edge_row.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace upscale {
namespace {

constexpr int rows_a_block = 32;

DisplayImage upscale_values(const DisplayImage& image, const UpscaleGrid& grid) {
  const Crop made = grid.made();
  const Axis columns = Axis::by_step(made.x, made.x + made.width, grid.to.width, grid.width);
  const Axis rows = Axis::by_step(made.y, made.y + made.height, grid.to.height, grid.height);
  std::vector<std::int32_t> taps[4];
  for (int t = 0; t < 4; ++t)
    for (const int x : columns.first) taps[t].push_back(4 * std::clamp(x - 1 + t - grid.x, 0, image.width() - 1));
  DisplayImage out(made.width, made.height);
  parallel_ranges(static_cast<std::size_t>(made.height), rows_a_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t o = begin; o < end; ++o) {
      SgsrRow row{.columns = {taps[0].data(), taps[1].data(), taps[2].data(), taps[3].data()},
                  .right = columns.beyond.data(),
                  .below = rows.beyond[o]};
      for (int t = 0; t < 4; ++t)
        row.rows[t] = &image.row(std::clamp(rows.first[o] - 1 + t - grid.y, 0, image.height() - 1)).data()->r;
      SgsrKernels::of().upscale_row(row, &out.row(static_cast<int>(o)).data()->r, static_cast<std::size_t>(made.width));
    }
  });
  return out;
}

class Sgsr1 : public SpatialUpscaler {
 public:
  int radius() const override { return 2 + continued_radius; }
  DisplayImage upscale(const DisplayImage& image, const UpscaleGrid& grid) const override {
    return filter_with_alpha(
        image, grid, [&](const DisplayImage& values) { return upscale_values(values, grid); }, &Display::g);
  }
};

constexpr Param params[] = {scale_param};

}  // namespace

Upscaler sgsr1() {
  return {.name = "sgsr1",
          .summary = "Snapdragon Game Super Resolution 1: twelve taps of green correct a bilinear image",
          .source = "Qualcomm 2023, snapdragon-gsr v1",
          .params = params,
          .make_spatial = [](const Settings&) -> std::unique_ptr<SpatialUpscaler> { return std::make_unique<Sgsr1>(); },
          .is_specification_only = true};
}

}  // namespace upscale
}  // namespace zoneplate
