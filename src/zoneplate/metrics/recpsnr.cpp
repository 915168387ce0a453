// SPDX-License-Identifier: Apache-2.0
// Recurrent PSNR: the signal-to-noise ratio of the last frame of a sequence.
//
// It measures a method whose history has settled, without the first frames after a cut. Weakness: one frame decides,
// so that it depends on where the sequence ends.
#include <limits>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/psnr.h"

namespace zoneplate::metrics {

Metric recpsnr() {
  return {.name = "recpsnr",
          .summary = "PSNR of the last frame of a sequence",
          .source = "Arm, neural-graphics-model-gym: recPSNR",
          .unit = "dB",
          .better = Better::Higher,
          .perfect = std::numeric_limits<double>::infinity(),
          .is_default = false,
          .frames = 2,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            return Score{.value = peak_signal_to_noise(reference.back(), test.back())};
          },
          .pool = [](std::span<const double> values) { return values.back(); }};
}

}  // namespace zoneplate::metrics
