// SPDX-License-Identifier: Apache-2.0
// The share of pixels that differ by more than a tolerance: the pass criterion of idiff, pixelmatch and odiff.
//
// With antialiasing=1, pixels that differ only by the coverage of an edge do not count: in each of the two images the
// colour of the pixel lies within those of the other's 3 × 3 pixels around it, as the colour of an edge lies between
// those of its two sides. A line or a spot that only one image has lies outside of the other's colours, and counts.
//
// Weakness: it counts pixels whether or not the error is visible; without antialiasing=1, an image shifted by a
// fraction of a pixel fails.
#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

/// The greatest difference of the colours, composited over black, and of alpha, in 8-bit codes.
double codes_apart(Display a, Display b) {
  const Codes p = codes_on_black(a), q = codes_on_black(b);
  const double alpha = std::abs(static_cast<double>(a.a) - static_cast<double>(b.a));
  return 255 * std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b), alpha});
}

/// Whether the colour of a pixel lies within the range of each channel in another image's 3 × 3 pixels, but for the
/// tolerance.
bool lies_within(Display color, const DisplayImage& other, int x, int y, double tolerance) {
  const auto channels = [](Display c) {
    const Codes k = codes_on_black(c);
    return std::array<double, 4>{k.r, k.g, k.b, static_cast<double>(c.a)};
  };
  const std::array<double, 4> own = channels(color);
  std::array<double, 4> low{2, 2, 2, 2}, high{-1, -1, -1, -1};
  for (int v = std::max(0, y - 1); v <= std::min(other.height() - 1, y + 1); ++v)
    for (int u = std::max(0, x - 1); u <= std::min(other.width() - 1, x + 1); ++u) {
      const std::array<double, 4> near = channels(other(u, v));
      for (std::size_t c = 0; c < 4; ++c) low[c] = std::min(low[c], near[c]), high[c] = std::max(high[c], near[c]);
    }
  for (std::size_t c = 0; c < 4; ++c)
    if (255 * std::max(low[c] - own[c], own[c] - high[c]) > tolerance) return false;
  return true;
}

Score measure(const Picture& whole_reference, const DisplayImage& test, double tolerance, bool ignores_coverage) {
  const DisplayImage& reference = whole_reference.display;
  // A difference of whole codes equals the tolerance; in floats it may be greater by a rounding error.
  constexpr double rounding = 1e-3;
  Score score;
  score.map = Plane<float>(reference.width(), reference.height());
  std::vector<double> greatest(static_cast<std::size_t>(reference.height()), 0.0);
  const double count = sum_rows(reference.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < reference.width(); ++x) {
      const double codes = codes_apart(reference(x, y), test(x, y));
      greatest[static_cast<std::size_t>(y)] = std::max(greatest[static_cast<std::size_t>(y)], codes);
      const bool is_off = codes > tolerance + rounding &&
                          !(ignores_coverage && lies_within(reference(x, y), test, x, y, tolerance + rounding) &&
                            lies_within(test(x, y), reference, x, y, tolerance + rounding));
      score.map(x, y) = is_off ? 1.0f : 0.0f;
      row += is_off;
    }
    return row;
  });
  score.value = 100 * count / measured_pixels(whole_reference);
  score.more = {{"pixels", count, ""}, {"max", std::ranges::max(greatest), "8-bit code"}};
  return score;
}

}  // namespace

Metric pixels() {
  static constexpr int flags[] = {0, 1};
  static const Param params[] = {
      real_param("tolerance", "8-bit codes by which a channel may differ, alpha included", 0, 0, 255),
      {.name = "antialiasing",
       .meaning = "1: without pixels that differ only by the coverage of an edge",
       .choices = flags}};
  return {.name = "pixels",
          .summary = "share of the pixels that differ by more than a tolerance",
          .source = "as the thresholds of idiff, pixelmatch and odiff",
          .unit = "%",
          .is_default = false,
          .params = params,
          .measure = [](Frames reference, Frames test, const Settings& settings) -> std::optional<Score> {
            return measure(reference[0], test[0].display, settings.number("tolerance"),
                           settings.integer("antialiasing") == 1);
          }};
}

}  // namespace zoneplate::metrics
