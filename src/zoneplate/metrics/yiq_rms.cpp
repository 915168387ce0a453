// SPDX-License-Identifier: Apache-2.0
// The root mean square of squared YIQ colour distances, in decibels: the measure of glTF's render fidelity collection,
// where two rasterisers' images of a scene differ by -16 to -35 dB.
//
// The distance is squared twice, so that a few wrong pixels outweigh a slight error everywhere. As the collection
// defines it, `empty=1`, images lie on white, and it is not symmetric: pixels that are empty in the test image are
// ignored.
#include <cmath>
#include <limits>
#include <numbers>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/power.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

// The greatest possible distance of codes in 0 to 255.
constexpr double max_distance = 35215;

/// An image's codes in 0 to 255, composited over white.
Codes codes_on_white(Display c) {
  const double alpha = c.a;
  const auto blend = [alpha](double code) { return 255 + (255 * code - 255) * alpha; };
  return {blend(c.r), blend(c.g), blend(c.b)};
}

/// The codes of a pixel that is measured over a given backdrop: black, where it is not opaque.
Codes codes_of(Display c, bool ignores_empty) {
  if (ignores_empty || c.a == 1) return codes_on_white(c);
  const Codes black = codes_on_black(c);
  return {255 * black.r, 255 * black.g, 255 * black.b};
}

/// Squared distance of two colours, weighted by the eye's sensitivity to luma and the two chromas.
double distance(Codes p, Codes q) {
  const double r = p.r - q.r, g = p.g - q.g, b = p.b - q.b;
  const double y = r * 0.29889531 + g * 0.58662247 + b * 0.11448223;
  const double i = r * 0.59597799 - g * 0.27417610 - b * 0.32180189;
  const double c = r * 0.21147017 - g * 0.52261711 + b * 0.31114694;
  return 0.5053 * y * y + 0.299 * i * i + 0.1957 * c * c;
}

std::optional<Score> measure(const Picture& whole_reference, const DisplayImage& test, bool ignores_empty) {
  const DisplayImage& reference = whole_reference.display;
  const auto is_seen = [&](int x, int y) {
    return is_measured(whole_reference, x, y) && (!ignores_empty || test(x, y).a > 0);
  };
  Score score;
  score.map = Plane<float>(reference.width(), reference.height());
  const double sum = sum_rows(reference.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < reference.width(); ++x) {
      if (!is_seen(x, y)) continue;
      const double d = distance(codes_of(reference(x, y), ignores_empty), codes_of(test(x, y), ignores_empty));
      row += d * d;
      score.map(x, y) = static_cast<float>(std::sqrt(d / max_distance));
    }
    return row;
  });
  const double count = sum_rows(test.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < test.width(); ++x) row += is_seen(x, y) ? 1 : 0;
    return row;
  });
  if (count == 0) return std::nullopt;
  const double ratio = sum > 0 ? std::sqrt(sum / count) / max_distance : 0;
  score.value = 10 * decimal_log(ratio);
  score.more = {{"ratio", ratio, ""}, {"seen", count / static_cast<double>(test.values().size()), "share of pixels"}};
  return score;
}

/// The root mean square over frames of the values behind the decibels.
double pool(std::span<const double> frames) {
  double sum = 0;
  for (const double decibels : frames) sum += natural_exp(decibels * 2 * std::numbers::ln10 / 10);
  return 10 * decimal_log(std::sqrt(sum / static_cast<double>(frames.size())));
}

}  // namespace

Metric yiq_rms() {
  static constexpr int flags[] = {0, 1};
  static constexpr Param params[] = {
      {.name = "empty",
       .meaning = "1: over white, without pixels that are empty in the test image, as the collection defines it",
       .value = 0,
       .choices = flags}};
  return {.name = "yiq_rms",
          .summary = "root mean square of squared YIQ distances",
          .source =
              "render fidelity tools of google/model-viewer; distance: Kotsarenko and Ramos, Measuring Perceived "
              "Color Difference Using YIQ NTSC Transmission Color Space in Mobile Applications, 2010",
          .unit = "dB",
          .perfect = -std::numeric_limits<double>::infinity(),
          .defines_alpha = [](const Settings& settings) { return settings.number("empty") == 1; },
          .params = params,
          .measure = [](Frames reference, Frames test, const Settings& settings) -> std::optional<Score> {
            return measure(reference[0], test[0].display, settings.number("empty") == 1);
          },
          .pool = pool};
}

}  // namespace zoneplate::metrics
