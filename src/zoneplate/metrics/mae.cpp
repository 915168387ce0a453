// SPDX-License-Identifier: Apache-2.0
// Mean absolute error, with the greatest error and its position: the simplest measure of difference.
#include <algorithm>
#include <cmath>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

/// The absolute differences of a pixel's codes: their mean over the three colours, and the greatest.
struct Difference {
  double mean = 0, greatest = 0;
};

Difference difference(Display a, Display b) {
  const Codes p = codes_on_black(a), q = codes_on_black(b);
  const double r = std::abs(p.r - q.r), g = std::abs(p.g - q.g), blue = std::abs(p.b - q.b);
  return {(r + g + blue) / 3, std::max({r, g, blue})};
}

Score measure(const Picture& whole_reference, const DisplayImage& test) {
  const DisplayImage& reference = whole_reference.display;
  Score score;
  score.map = Plane<float>(reference.width(), reference.height());
  std::vector<double> greatest(static_cast<std::size_t>(reference.height()), 0.0);
  const double sum = sum_rows(reference.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < reference.width(); ++x) {
      const Difference d = difference(reference(x, y), test(x, y));
      row += d.mean;
      greatest[static_cast<std::size_t>(y)] = std::max(greatest[static_cast<std::size_t>(y)], d.greatest);
      score.map(x, y) = static_cast<float>(d.greatest);
    }
    return row;
  });

  // The 99th percentile measures the worst regions without a few outliers.
  std::vector<float> sorted;
  for (int y = 0; y < reference.height(); ++y)
    for (int x = 0; x < reference.width(); ++x)
      if (is_measured(whole_reference, x, y)) sorted.push_back(score.map(x, y));
  const std::size_t rank = (sorted.size() - 1) * 99 / 100;
  std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(rank));
  score.value = sum / static_cast<double>(sorted.size());
  score.more = {{"max", std::ranges::max(greatest), "code"}, {"p99", static_cast<double>(sorted[rank]), "code"}};
  return score;
}

}  // namespace

Metric mae() {
  return {.name = "mae",
          .summary = "mean absolute error of sRGB codes in [0, 1]",
          .source = "the definition",
          .unit = "code",
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            return measure(reference[0], test[0].display);
          }};
}

}  // namespace zoneplate::metrics
