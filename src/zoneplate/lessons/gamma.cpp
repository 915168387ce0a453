// SPDX-License-Identifier: Apache-2.0
// Gamma: sums of light are sums of linear values; sums of sRGB values are too dark.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/image/transfer.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/diagram.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/sdf/exact_coverage.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::lessons {
namespace gamma_lesson {
namespace {

using sdf::Point;
constexpr int factor = 8;
constexpr int plot_width = 480;  // for which the letters of the plot are designed

/// Thin white lines in several directions, as exact areas.
Plane<float> fan(int side) {
  sdf::Outline lines;
  const Point hub{-2.0, side + 2.0};
  for (int i = 0; i < 9; ++i) {
    const SineCosine angle = sin_cos_pi(0.04 + 0.054 * i);
    const Point along{angle.cosine, -angle.sine}, across = Point{-along.y, along.x} * 0.6;
    const Point a = hub + along * (side * 0.35), b = hub + along * (side * 2.0);
    const Point corners[] = {a + across, b + across, b - across, a - across};
    for (sdf::Contour& c : sdf::polygon(corners).contours) lines.contours.push_back(std::move(c));
  }
  return sdf::exact_coverage(lines, {side, side, {}, 1});
}

Rgba8 grey(std::uint8_t code) { return {code, code, code, 255}; }

/// Coverage as light, or as sRGB values.
struct Blend {
  Rgba8Image image;
  double light = 0;  ///< mean over the image
};
Blend blended(const Plane<float>& coverage, bool is_linear) {
  Blend out{Rgba8Image(coverage.width(), coverage.height())};
  for (std::size_t i = 0; i < coverage.values().size(); ++i) {
    const float c = coverage.values()[i];
    const std::uint8_t code = is_linear ? encode_srgb8(c) : static_cast<std::uint8_t>(c * 255 + 0.5f);
    out.image.values()[i] = grey(code);
    out.light += static_cast<double>(decode_srgb8(code));
  }
  out.light /= static_cast<double>(coverage.values().size());
  return out;
}

double mean_of(const Plane<float>& plane) {
  double sum = 0;
  for (const float v : plane.values()) sum += static_cast<double>(v);
  return sum / static_cast<double>(plane.values().size());
}

/// A pattern of black and white rows around two patches: the mean of the sRGB values, and of the light.
Rgba8Image patches(int side) {
  Rgba8Image image(side, side);
  const std::uint8_t by_code = 128, by_light = encode_srgb8(0.5f);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      image(x, y) = grey(y % 2 == 0 ? 0 : 255);
      const bool is_patch_row = y > side / 4 && y < side * 3 / 4;
      if (is_patch_row && x > side / 9 && x < side * 4 / 9) image(x, y) = grey(by_code);
      if (is_patch_row && x > side * 5 / 9 && x < side * 8 / 9) image(x, y) = grey(by_light);
    }
  return image;
}

Plot curve_plot() {
  Plot plot{.title = "White on black",
            .x = {"coverage (%)", 0, 100},
            .y = {"light (% of white)", 0, 100},
            .curves = {{.name = "in sRGB values", .points = {}}, {.name = "in linear light", .points = {}}}};
  for (int i = 0; i <= 100; ++i) {
    plot.curves[0].points.emplace_back(i, 100 * static_cast<double>(decode_srgb(static_cast<float>(i) / 100)));
    plot.curves[1].points.emplace_back(i, i);
  }
  return plot;
}

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, crop = side / factor;
  const Plane<float> coverage = fan(crop);
  const Blend codes = blended(coverage, false), light = blended(coverage, true);
  const double true_light = mean_of(coverage);
  const auto large = [&](const Rgba8Image& image) { return enlarged(image, factor); };
  Figure figure{.title = "Gamma: colours are blended in linear light, not in sRGB values", .rows = {{}}};
  figure.rows[0].push_back(
      {large(codes.image),
       fmt::format("Blended in sRGB values\nThin white lines look like ropes: pixels that are half covered "
                   "are too dark. The image has {}\u00a0% of the lines' light.",
                   number(100 * codes.light / true_light, 0))});
  figure.rows[0].push_back(
      {large(light.image),
       fmt::format("Blended in linear light\nCoverage is light, which is encoded for the display last: "
                   "{}\u00a0% of the lines' light.",
                   number(100 * light.light / true_light, 0))});
  figure.rows[0].push_back(
      {patches(side),
       "Black and white rows\nOf one pixel each, at 1:1: from a distance the right patch, code 188, merges "
       "with them, because it has half of the light of white. Code 128 on the left is darker."});
  figure.rows[0].push_back(
      plot_panel(curve_plot(), side, side,
                 fmt::format("Coverage and light\nA pixel that is half covered has {}\u00a0% of the light of white if "
                             "sRGB values are blended.",
                             number(100 * static_cast<double>(decode_srgb(0.5f)), 0)),
                 plot_width));
  figure.text =
      "sRGB values are spaced as the eye sees differences, not as light adds up. Filters, antialiasing, transparency "
      "and mip "
      "levels are sums of light: decode, sum, encode. The figures are measured in these images.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace gamma_lesson

Demo demo_gamma() { return {"gamma", "blending of sRGB values and in linear light", gamma_lesson::make}; }

}  // namespace zoneplate::lessons
