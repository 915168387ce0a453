// SPDX-License-Identifier: Apache-2.0
// The share of pixels that differ by more than a tolerance: the pass criterion of idiff, pixelmatch and odiff.
//
// Weakness: it counts pixels whether or not the error is visible; an image shifted by a fraction of a pixel fails.
#include <algorithm>
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

Score measure(const Picture& whole_reference, const DisplayImage& test, double tolerance) {
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
      const bool is_off = codes > tolerance + rounding;
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
  static const Param params[] = {
      real_param("tolerance", "8-bit codes by which a channel may differ, alpha included", 0, 0, 255)};
  return {.name = "pixels",
          .summary = "share of the pixels that differ by more than a tolerance",
          .source = "as the thresholds of idiff, pixelmatch and odiff",
          .unit = "%",
          .is_default = false,
          .params = params,
          .measure = [](Frames reference, Frames test, const Settings& settings) -> std::optional<Score> {
            return measure(reference[0], test[0].display, settings.number("tolerance"));
          }};
}

}  // namespace zoneplate::metrics
