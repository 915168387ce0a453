// SPDX-License-Identifier: Apache-2.0
// Upscaling by tables of filters that least squares have found (RAISR): the simple siblings of `learned` and
// `learned-still`.
//
// learned-table is `taau`, whose images are filtered by 3 × 3 pixels, by the number of samples that a pixel rests on
// and the direction, strength and coherence of the gradient. learned-table-still filters, by 5 × 5 pixels, an image
// that bilinear interpolation in linear light has upscaled; the phase of the pixel takes the place of the count.
// Results are within the extremes of the nearest 3 × 3 pixels.
//
// Weaknesses: a filter of a few pixels draws nothing that is not there, and classes that few pixels of the training had
// change little (train/README.md).
//
// Source: Romano, Isidoro and Milanfar, RAISR: Rapid and Accurate Image Super Resolution, IEEE Trans. Computational
// Imaging 3(1), 2017.
#include "zoneplate/upscale/table/learned_table.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/network/trained.h"
#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/upscale/alpha.h"
#include "zoneplate/upscale/jittered_frame.h"
#include "zoneplate/upscale/taau/taau_method.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

const FilterTable& table_of_phases() {
  static const FilterTable table(network::trained_weights(network::Trained::TableStill), PhaseGroups::form,
                                 "the program's own");
  return table;
}

/// Output pixels beyond a part of an image that its filters and classes read.
constexpr int halo = FilterTable::window / 2 + 1;

DisplayImage upscale_opaque(const DisplayImage& image, const UpscaleGrid& grid) {
  LinearImage light(image.width(), image.height());
  std::ranges::transform(image.values(), light.values().begin(), [](const Display& c) {
    return Linear{decode_srgb(c.r), decode_srgb(c.g), decode_srgb(c.b), c.a};
  });
  const Crop made = grid.made();
  UpscaleGrid wide = grid;
  const int left = std::max(made.x - halo, 0), top = std::max(made.y - halo, 0);
  wide.to.crop = Crop{left, top, std::min(made.x + made.width + halo, grid.to.width) - left,
                      std::min(made.y + made.height + halo, grid.to.height) - top};
  const Interpolated base = interpolated(light, wide);
  const LinearImage out = filtered(base.image, table_of_phases(), base.group);
  DisplayImage display(made.width, made.height);
  for (int y = 0; y < made.height; ++y)
    for (int x = 0; x < made.width; ++x) {
      const Linear& c = out(x + made.x - left, y + made.y - top);
      display(x, y) = {encode_srgb(c.r), encode_srgb(c.g), encode_srgb(c.b), 1};
    }
  return display;
}

class TableUpscaler : public SpatialUpscaler {
 public:
  int radius() const override { return 1 + halo + continued_radius; }
  DisplayImage upscale(const DisplayImage& image, const UpscaleGrid& grid) const override {
    return filter_with_alpha(
        image, grid, [&](const DisplayImage& values) { return upscale_opaque(values, grid); }, &Display::g);
  }
};

constexpr Param table_params[] = {
    real_param(scale_param.name, scale_param.meaning, 2, scale_param.low, scale_param.high), bias_param(-1)};
constexpr Param still_params[] = {table_params[0]};

}  // namespace

Plane<std::uint8_t> CountGroups::of(const Plane<float>& counts) {
  auto out = Plane<std::uint8_t>::unset(counts.width(), counts.height());
  parallel_ranges(static_cast<std::size_t>(counts.height()), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      const std::span<const float> count = counts.row(y);
      const std::span<std::uint8_t> group = out.row(y);
      for (std::size_t x = 0; x < count.size(); ++x) {
        int above = 0;
        for (const float bound : bounds) above += count[x] > bound ? 1 : 0;
        group[x] = static_cast<std::uint8_t>(above);
      }
    }
  });
  return out;
}

const FilterTable& table_of_counts() {
  static const FilterTable table(network::trained_weights(network::Trained::Table), CountGroups::form,
                                 "the program's own");
  return table;
}

Interpolated interpolated(const LinearImage& image, const UpscaleGrid& grid) {
  const Crop made = grid.made();
  const double step_x = static_cast<double>(grid.width) / grid.to.width,
               step_y = static_cast<double>(grid.height) / grid.to.height;
  Interpolated out{resample(image, made.width, made.height, make_kernel("tent"),
                            {.step_x = step_x,
                             .step_y = step_y,
                             .shift_x = -static_cast<double>(grid.x),
                             .shift_y = -static_cast<double>(grid.y),
                             .first_x = made.x,
                             .first_y = made.y}),
                   Plane<std::uint8_t>(made.width, made.height)};
  const auto is_after = [](int o, double step) {
    const double place = (o + 0.5) * step;
    return place - std::floor(place) >= 0.5;
  };
  for (int y = 0; y < made.height; ++y)
    for (int x = 0; x < made.width; ++x)
      out.group(x, y) = static_cast<std::uint8_t>(2 * is_after(made.y + y, step_y) + is_after(made.x + x, step_x));
  return out;
}

Upscaler learned_table() {
  return {.name = "learned-table",
          .summary = "taau, whose images filters by least squares improve, by count and gradient",
          .source = "Romano 2017, RAISR; Zoneplate, train/",
          .params = table_params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<TaauMethod<TableMean>>("learned-table", s.number("scale"), s.number("bias"));
          },
          .is_specification_only = true};
}

Upscaler learned_table_still() {
  return {.name = "learned-table-still",
          .summary = "bilinear interpolation that filters by least squares improve, by phase and gradient",
          .source = "Romano 2017, RAISR; Zoneplate, train/",
          .params = still_params,
          .make_spatial = [](const Settings&) -> std::unique_ptr<SpatialUpscaler> {
            return std::make_unique<TableUpscaler>();
          },
          .is_specification_only = true};
}

}  // namespace zoneplate::upscale
