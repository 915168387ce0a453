// SPDX-License-Identifier: Apache-2.0
// Flicker: changes from frame to frame that the reference does not have.
//
// In a static scene it measures shimmering edges; in a moving one, only changes that differ from the reference's.
// Weakness: blur lowers it, so that a measure of sharpness (edge_response) must accompany it.
#include <algorithm>
#include <cmath>

#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

/// Over the pixels of a plane that are measured.
double root_mean_square(const Plane<double>& plane, const Picture& reference) {
  const double sum = sum_rows(plane.height(), [&](int y) {
    double row = 0;
    for (int x = 0; x < plane.width(); ++x)
      if (is_measured(reference, x, y)) row += plane(x, y) * plane(x, y);
    return row;
  });
  return std::sqrt(sum / measured_pixels(reference));
}

/// The change of luma from one frame to the next.
Plane<double> change(Frames frames) {
  Plane<double> difference = luma_plane(frames[1].display);
  const Plane<double> before = luma_plane(frames[0].display);
  for (std::size_t i = 0; i < difference.values().size(); ++i) difference.values()[i] -= before.values()[i];
  return difference;
}

Score measure(Frames reference, Frames test) {
  const Plane<double> expected = change(reference);
  Plane<double> found = change(test);
  Score score;
  score.more = {{"change", root_mean_square(found, reference[1]), "code"},
                {"reference_change", root_mean_square(expected, reference[1]), "code"}};
  score.map = Plane<float>(found.width(), found.height());
  for (std::size_t i = 0; i < found.values().size(); ++i) {
    double& excess = found.values()[i];
    excess -= expected.values()[i];
    score.map.values()[i] = static_cast<float>(std::min(1.0, std::abs(excess)));
  }
  score.value = root_mean_square(found, reference[1]);
  return score;
}

}  // namespace

Metric flicker() {
  return {.name = "flicker",
          .summary = "root mean square over pixels and frames of the change of luma that the reference has not",
          .source = "temporal high-pass of two frames of the difference of the sequences",
          .unit = "code",
          .frames = 2,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            return measure(reference, test);
          },
          .pool = root_mean_square_of};
}

}  // namespace zoneplate::metrics
