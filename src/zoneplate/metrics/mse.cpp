// SPDX-License-Identifier: Apache-2.0
// Mean squared error, the usual baseline for other metrics.
//
// Weakness: it ignores visibility: an error counts the same alone, in a texture or in a uniform sky.
#include "zoneplate/metrics/mse.h"

#include <cmath>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

double squared_difference(Codes a, Codes b) {
  const double r = a.r - b.r, g = a.g - b.g, blue = a.b - b.b;
  return r * r + g * g + blue * blue;
}

/// Over pixels and colours.
double sum_of_squares(const DisplayImage& reference, const DisplayImage& test) {
  return sum_rows(reference.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < reference.width(); ++x) {
      row += squared_difference(codes_on_black(reference(x, y)), codes_on_black(test(x, y)));
    }
    return row;
  });
}

}  // namespace

double mean_squared_error(const DisplayImage& reference, const DisplayImage& test) {
  return sum_of_squares(reference, test) / (3.0 * static_cast<double>(reference.values().size()));
}

double mean_squared_error(const Picture& reference, const Picture& test) {
  return sum_of_squares(reference.display, test.display) / (3.0 * measured_pixels(reference));
}

Plane<float> squared_error_map(const DisplayImage& reference, const DisplayImage& test) {
  Plane<float> map(reference.width(), reference.height());
  for_rows(map.height(), [&](int y) {
    for (int x = 0; x < map.width(); ++x)
      map(x, y) = static_cast<float>(
          std::sqrt(squared_difference(codes_on_black(reference(x, y)), codes_on_black(test(x, y))) / 3));
  });
  return map;
}

Metric mse() {
  return {.name = "mse",
          .summary = "mean squared error of sRGB codes in [0, 1]",
          .source = "the definition",
          .unit = "code²",
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            const double mse = mean_squared_error(reference[0], test[0]);
            return Score{.value = mse,
                         .more = {{"rmse", std::sqrt(mse), "code"}},
                         .map = squared_error_map(reference[0].display, test[0].display)};
          }};
}

}  // namespace zoneplate::metrics
