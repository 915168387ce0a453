// SPDX-License-Identifier: Apache-2.0
// Structural similarity over five scales: coarse structure has more weight than fine detail, as at a viewing distance.
//
// Borders are handled as in ssim; there is no map, because the scales differ in size.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/power.h"
#include "zoneplate/metrics/ssim/ssim.h"

namespace zoneplate::metrics {
namespace {

// From fine to coarse: fitted by the paper's authors to viewers' matches of distortions at five scales.
constexpr std::array<double, 5> scale_weights = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

Plane<double> half_size(const Plane<double>& image) {
  Plane<double> half(image.width() / 2, image.height() / 2);
  for (int y = 0; y < half.height(); ++y) {
    for (int x = 0; x < half.width(); ++x) {
      half(x, y) =
          ((image(2 * x, 2 * y) + image(2 * x + 1, 2 * y)) + (image(2 * x, 2 * y + 1) + image(2 * x + 1, 2 * y + 1))) /
          4;
    }
  }
  return half;
}

Plane<std::uint8_t> half_mask(const Plane<std::uint8_t>& mask) {
  Plane<std::uint8_t> half(mask.width() / 2, mask.height() / 2);
  for (int y = 0; y < half.height(); ++y)
    for (int x = 0; x < half.width(); ++x)
      half(x, y) = mask(2 * x, 2 * y) != 0 && mask(2 * x + 1, 2 * y) != 0 && mask(2 * x, 2 * y + 1) != 0 &&
                   mask(2 * x + 1, 2 * y + 1) != 0;
  return half;
}

}  // namespace

double multiscale_similarity(const Plane<double>& reference, const Plane<double>& test,
                             Plane<std::uint8_t> is_ignored) {
  Plane<double> a = reference, b = test;
  double product = 1;
  for (std::size_t scale = 0; scale < scale_weights.size(); ++scale) {
    const Similarity s = structural_similarity(a, b, {}, is_ignored);
    const bool is_last = scale + 1 == scale_weights.size();
    if (std::isnan(s.ssim)) return s.ssim;
    const double mean = std::max(0.0, is_last ? s.ssim : s.contrast);
    product *= mean == 1 ? 1 : power(mean, scale_weights[scale]);
    if (!is_last) a = half_size(a), b = half_size(b), is_ignored = half_mask(is_ignored);
  }
  return product;
}

Metric ms_ssim() {
  return {.name = "ms_ssim",
          .summary = "structural similarity over five scales, of Rec.709 luma of sRGB codes",
          .source = "Wang, Simoncelli, Bovik 2003",
          .unit = "",
          .better = Better::Higher,
          .perfect = 1.0,
          .smallest = 176,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            const double value = multiscale_similarity(luma_plane(reference[0].display), luma_plane(test[0].display),
                                                       reference[0].is_ignored);
            return std::isnan(value) ? std::nullopt : std::optional(Score{.value = value});
          }};
}

}  // namespace zoneplate::metrics
