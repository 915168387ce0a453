// SPDX-License-Identifier: Apache-2.0
// Peak signal-to-noise ratio of luma: it ignores errors of hue, and correlates better with the visibility of edges.
#include <limits>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/psnr.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {

double luma_peak_signal_to_noise(const Picture& whole_reference, const Picture& whole_test, LumaWeights weights) {
  const DisplayImage &reference = whole_reference.display, &test = whole_test.display;
  const double sum = sum_rows(reference.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < reference.width(); ++x) {
      const double d = luma(codes_on_black(reference(x, y)), weights) - luma(codes_on_black(test(x, y)), weights);
      row += d * d;
    }
    return row;
  });
  return psnr_of_mse(sum / measured_pixels(whole_reference));
}

Metric psnr_luma() {
  static constexpr int standards[] = {601, 709};
  static constexpr Param params[] = {
      {.name = "rec", .meaning = "luma weights of ITU-R BT.601 or BT.709", .value = 709, .choices = standards}};
  return {.name = "psnr_luma",
          .summary = "peak signal-to-noise ratio of luma of sRGB codes",
          .source = "the definition; luma weights of ITU-R BT.709-6 or BT.601-7",
          .unit = "dB",
          .better = Better::Higher,
          .perfect = std::numeric_limits<double>::infinity(),
          .params = params,
          .measure = [](Frames reference, Frames test, const Settings& settings) -> std::optional<Score> {
            const LumaWeights weights = settings.number("rec") == 601 ? rec601_luma : rec709_luma;
            return Score{.value = luma_peak_signal_to_noise(reference[0], test[0], weights)};
          },
          .pool = pool_psnr};
}

}  // namespace zoneplate::metrics
