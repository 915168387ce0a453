// Peak signal-to-noise ratio of luma: blind to errors of hue alone, closer to what an eye sees of edges.
#include <limits>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/psnr.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {

double luma_peak_signal_to_noise(const DisplayImage& reference, const DisplayImage& test) {
  const double sum = sum_rows(reference.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < reference.width(); ++x) {
      const double d = luma(codes_on_black(reference(x, y))) - luma(codes_on_black(test(x, y)));
      row += d * d;
    }
    return row;
  });
  return psnr_of_mse(sum / static_cast<double>(reference.values().size()));
}

Metric psnr_luma() {
  return {.name = "psnr_luma",
          .summary = "peak signal-to-noise ratio of Rec.709 luma of sRGB codes",
          .source = "the definition; luma weights of ITU-R BT.709",
          .unit = "dB",
          .better = Better::Higher,
          .perfect = std::numeric_limits<double>::infinity(),
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            return Score{.value = luma_peak_signal_to_noise(reference[0].display, test[0].display)};
          },
          .pool = pool_psnr};
}

}  // namespace zoneplate::metrics
