// SPDX-License-Identifier: Apache-2.0
// Disocclusion error: what a method shows where a surface has just come into view, and no history of it exists.
//
// It separates this failure from all others, which the error of the whole image mixes. Weakness: it requires the exact
// visibility that only a renderer has, so that images alone cannot be measured.
#include <algorithm>
#include <cmath>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

double mean_square_difference(const Display& a, const Display& b) {
  const Codes p = codes_on_black(a), q = codes_on_black(b);
  const double r = p.r - q.r, g = p.g - q.g, blue = p.b - q.b;
  return ((r * r + g * g) + blue * blue) / 3;
}

std::optional<Score> measure(const Picture& reference, const Picture& test) {
  const Plane<std::uint8_t>& is_uncovered = reference.is_uncovered;
  const auto pixels = std::ranges::count(is_uncovered.values(), std::uint8_t{1});
  if (pixels == 0) return std::nullopt;
  Score score;
  score.map = Plane<float>(reference.width(), reference.height());
  const double sum = sum_rows(reference.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < reference.width(); ++x) {
      if (is_uncovered(x, y) == 0) continue;
      const double square = mean_square_difference(reference.display(x, y), test.display(x, y));
      score.map(x, y) = static_cast<float>(std::min(1.0, std::sqrt(square)));
      row += square;
    }
    return row;
  });
  score.value = std::sqrt(sum / static_cast<double>(pixels));
  const auto all = static_cast<double>(is_uncovered.values().size());
  score.more = {{"pixels", static_cast<double>(pixels) / all, "share of the pixels"}};
  return score;
}

}  // namespace

Metric disocclusion() {
  return {.name = "disocclusion",
          .summary = "root mean square error where a surface was hidden in the frame before; of compare --frames only",
          .source = "the definition; visibility by rays to the triangles of the frame before",
          .unit = "code",
          .is_default = false,
          .frames = 2,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            return measure(reference.back(), test.back());
          },
          .pool = root_mean_square_of};
}

}  // namespace zoneplate::metrics
