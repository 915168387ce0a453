// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

Score flicker_of(std::span<const Picture> reference, std::span<const Picture> test) {
  const Choice choice = choose_metric(metrics(), "flicker");
  EXPECT_EQ(choice.metric->frames, 2);
  return *choice.metric->measure(reference, test, choice.settings);
}

Picture flat_frame(float code) { return make_picture(DisplayImage(8, 4, {code, code, code, 1})); }

TEST(Flicker, OfAStillReferenceIsTheChange) {
  const std::vector<Picture> still = {flat_frame(0.5f), flat_frame(0.5f)},
                             blinking = {flat_frame(0.5f), flat_frame(0.75f)};
  EXPECT_NEAR(flicker_of(still, blinking).value, 0.25, 1e-15);
  EXPECT_EQ(flicker_of(still, still).value, 0);
}

TEST(Flicker, ForgivesChangeThatTheReferenceHas) {
  const std::vector<Picture> fading = {flat_frame(0.25f), flat_frame(0.5f)},
                             fading_lighter = {flat_frame(0.5f), flat_frame(0.75f)};
  EXPECT_NEAR(flicker_of(fading, fading_lighter).value, 0, 1e-15);
}

TEST(Flicker, OfASineIsItsAmplitudeTimesTheDifferenceFilter) {
  // For x_t = a sin(2π f t), the mean square of x_t - x_{t-1} over whole periods is 2 a² sin²(π f).
  constexpr int period = 8;
  constexpr double amplitude = 0.25;
  std::vector<Picture> still(period + 1, flat_frame(0.5f)), wave;
  for (int t = 0; t <= period; ++t) {
    wave.push_back(flat_frame(static_cast<float>(0.5 + amplitude * std::sin(2 * 3.14159265358979 * t / period))));
  }
  std::vector<double> values;
  for (std::size_t t = 0; t < period; ++t) {
    values.push_back(flicker_of(std::span(still).subspan(t, 2), std::span(wave).subspan(t, 2)).value);
  }
  EXPECT_NEAR(root_mean_square_of(values), amplitude * std::sqrt(2.0) * std::sin(3.14159265358979 / period), 1e-6);
}

}  // namespace
}  // namespace zoneplate::metrics
