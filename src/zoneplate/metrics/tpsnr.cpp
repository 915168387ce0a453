// SPDX-License-Identifier: Apache-2.0
// Temporal PSNR: the signal-to-noise ratio of the change from frame to frame.
//
// It sees flicker and swimming, to which the PSNR of single frames is blind. Weakness: blur lowers changes and is
// rewarded where the reference changes little, so that the PSNR must accompany it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/psnr.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

/// The squared difference of two changes of a colour over black, summed over red, green and blue.
double squared_excess(const Display& r0, const Display& r1, const Display& t0, const Display& t1) {
  const auto excess = [&](float Display::*c) {
    const auto code = [&](const Display& d) { return static_cast<double>(d.*c) * static_cast<double>(d.a); };
    const double e = (code(t1) - code(t0)) - (code(r1) - code(r0));
    return e * e;
  };
  return (excess(&Display::r) + excess(&Display::g)) + excess(&Display::b);
}

Score measure_change(Frames reference, Frames test) {
  const DisplayImage &r0 = reference[0].display, &r1 = reference[1].display;
  const DisplayImage &t0 = test[0].display, &t1 = test[1].display;
  Score score;
  score.map = Plane<float>(r1.width(), r1.height());
  const double sum = sum_rows(r1.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < r1.width(); ++x) {
      const double square = squared_excess(r0(x, y), r1(x, y), t0(x, y), t1(x, y));
      score.map(x, y) = static_cast<float>(std::min(1.0, std::sqrt(square / 3)));
      row += square;
    }
    return row;
  });
  score.value = psnr_of_mse(sum / (3 * measured_pixels(reference[1])));
  return score;
}

}  // namespace

Metric tpsnr() {
  return {.name = "tpsnr",
          .summary = "PSNR of the change from frame to frame against that of the reference",
          .source = "Arm, neural-graphics-model-gym: tPSNR",
          .unit = "dB",
          .better = Better::Higher,
          .perfect = std::numeric_limits<double>::infinity(),
          .is_default = false,
          .frames = 2,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            return measure_change(reference, test);
          },
          .pool = pool_psnr};
}

}  // namespace zoneplate::metrics
