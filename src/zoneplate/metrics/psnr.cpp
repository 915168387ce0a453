// SPDX-License-Identifier: Apache-2.0
// Peak signal-to-noise ratio: mean squared error on a logarithmic scale, as papers report it.
//
// Weaknesses: those of mean squared error; and the proportion of empty background changes it, so that only values of
// the same image are comparable.
#include "zoneplate/metrics/psnr.h"

#include <limits>
#include <numbers>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/mse.h"
#include "zoneplate/metrics/power.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {

double psnr_of_mse(double mse) { return mse > 0 ? -10 * decimal_log(mse) : std::numeric_limits<double>::infinity(); }

double peak_signal_to_noise(const Picture& reference, const Picture& test) {
  return psnr_of_mse(mean_squared_error(reference, test));
}

double pool_psnr(std::span<const double> frames) {
  double mse = 0;
  for (const double psnr : frames) mse += natural_exp(psnr * -std::numbers::ln10 / 10);
  return psnr_of_mse(mse / static_cast<double>(frames.size()));
}

Metric psnr() {
  return {.name = "psnr",
          .summary = "peak signal-to-noise ratio of sRGB codes, all colours together",
          .source = "the definition: 10 log10(1 / mse)",
          .unit = "dB",
          .better = Better::Higher,
          .perfect = std::numeric_limits<double>::infinity(),
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            return Score{.value = peak_signal_to_noise(reference[0], test[0]),
                         .map = squared_error_map(reference[0].display, test[0].display)};
          },
          .pool = pool_psnr};
}

}  // namespace zoneplate::metrics
