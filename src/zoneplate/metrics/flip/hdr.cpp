// SPDX-License-Identifier: Apache-2.0
// FLIP for high dynamic range: the images are compared at a range of exposures derived from the reference, and
// each pixel has its greatest error.
//
// Weakness: one outlier of unbounded radiance (firefly) in the reference adds irrelevant exposures.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "zoneplate/metrics/flip/flip.h"
#include "zoneplate/metrics/power.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

// The ACES curve (k0 x² + k1 x + k2) / (k3 x² + k4 x + k5) of Narkowicz's fit, without its factor 0.6 of exposure.
constexpr double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03, k2 = 0, k3 = 0.6 * 0.6 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;

double aces(double x) { return std::clamp(((k0 * x + k1) * x + k2) / ((k3 * x + k4) * x + k5), 0.0, 1.0); }

/// The light that the curve maps to 0.85.
double light_near_white() {
  const double a = k0 - 0.85 * k3, b = k1 - 0.85 * k4, c = k2 - 0.85 * k5;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

LinearImage expose(const LinearImage& image, double exposure) {
  const double factor = natural_exp(exposure * std::numbers::ln2);
  const auto shown = [factor](float v) { return v > 0 ? static_cast<float>(aces(factor * v)) : 0.0f; };
  LinearImage out(image.width(), image.height());
  for_rows(image.height(), [&](int y) {
    std::ranges::transform(image.row(y), out.row(y).begin(), [&](const Linear& c) {
      return Linear{shown(c.r), shown(c.g), shown(c.b), 1};
    });
  });
  return out;
}

}  // namespace

std::vector<double> flip_exposures(const LinearImage& reference) {
  std::vector<double> luminance;
  luminance.reserve(reference.values().size());
  // Infinite light is clamped to the greatest float, so that the exposures are finite.
  const auto bounded = [](float x) { return std::min(std::max(0.0f, x), std::numeric_limits<float>::max()); };
  for (const Linear& c : reference.values())
    luminance.push_back(0.2126 * bounded(c.r) + 0.7152 * bounded(c.g) + 0.0722 * bounded(c.b));

  // Black is replaced by the smallest luminance that a float resolves next to 1, so that the exposures are bounded.
  constexpr double darkest = std::numeric_limits<float>::epsilon();
  const auto middle = luminance.begin() + static_cast<std::ptrdiff_t>(luminance.size() / 2);
  const double greatest = std::max(darkest, std::ranges::max(luminance));
  std::ranges::nth_element(luminance, middle);
  const double median = std::max(darkest, *middle);

  const double white = light_near_white();
  const double start = binary_log(white / greatest), stop = binary_log(white / median);
  const int count = std::max(2, static_cast<int>(std::ceil(stop - start)));
  std::vector<double> exposures;
  for (int i = 0; i < count; ++i) exposures.push_back(start + (stop - start) * i / (count - 1));
  return exposures;
}

Plane<float> hdr_flip_map(const LinearImage& reference, const LinearImage& test, double pixels_per_degree) {
  const std::vector<double> exposures = flip_exposures(reference);
  Plane<float> greatest(reference.width(), reference.height());
  for (std::size_t i = 0; i < exposures.size(); ++i) {
    if (i > 0 && exposures[i] == exposures[i - 1]) continue;
    const Plane<float> map = flip_map(expose(reference, exposures[i]), expose(test, exposures[i]), pixels_per_degree);
    for (std::size_t p = 0; p < map.values().size(); ++p) {
      greatest.values()[p] = std::max(greatest.values()[p], map.values()[p]);
    }
  }
  return greatest;
}

Metric flip_hdr() {
  static constexpr Param params[] = {
      real_param("ppd", "pixels per degree of view", default_pixels_per_degree, 1, 1000)};
  return {.name = "flip_hdr",
          .summary = "FLIP of unbounded light: the worst over the reference's exposures",
          .source = "Andersson et al. 2021",
          .unit = "",
          .is_default = false,
          .params = params,
          .measure = [](Frames reference, Frames test, const Settings& settings) -> std::optional<Score> {
            Score score =
                score_of_flip(hdr_flip_map(reference[0].linear, test[0].linear, settings.number("ppd")), reference[0]);
            const std::vector<double> exposures = flip_exposures(reference[0].linear);
            score.more.push_back({"exposures", static_cast<double>(exposures.size()), ""});
            score.more.push_back({"start", exposures.front(), "stops"});
            score.more.push_back({"stop", exposures.back(), "stops"});
            return score;
          }};
}

}  // namespace zoneplate::metrics
