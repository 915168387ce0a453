// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/spectrum/radial_power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "zoneplate/math/random.h"
#include "zoneplate/metrics/charts_for_test.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

Plane<double> wave(int width, int height, double fx, double fy, double amplitude) {
  Plane<double> out(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) out(x, y) = 0.5 + amplitude * cos_pi(2 * (fx * (x + 0.5) + fy * (y + 0.5)));
  }
  return out;
}

TEST(RadialPower, OfWhiteNoiseIsItsVarianceEverywhere) {
  Plane<double> noise(192, 160);
  for (int y = 0; y < noise.height(); ++y)
    for (int x = 0; x < noise.width(); ++x)
      noise(x, y) = unit_float(hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
  const RadialPower radial = radial_power_of(windowed_spectrum(noise));
  ASSERT_GE(radial.power.size(), 80u);
  EXPECT_NEAR(radial.frequency[79], 0.5, 0.5 / 80);
  for (std::size_t i = 40; i < 80; ++i) EXPECT_NEAR(radial.power[i], 1.0 / 12, 0.03) << i;
  const double mean = std::accumulate(radial.power.begin() + 10, radial.power.begin() + 80, 0.0) / 70;
  EXPECT_NEAR(mean, 1.0 / 12, 0.002);
}

TEST(RadialPower, PeaksAtTheFrequencyOfAWave) {
  const RadialPower radial = radial_power_of(windowed_spectrum(wave(128, 96, 0.15, 0.2, 0.3)));
  const auto peak = std::ranges::max_element(radial.power) - radial.power.begin();
  EXPECT_NEAR(radial.frequency[static_cast<std::size_t>(peak)], 0.25, 0.01);
}

TEST(BandPower, HoldsTheMeanSquareOfAWave) {
  const Spectrum spectrum = windowed_spectrum(wave(128, 96, 0.15, 0.2, 0.3));
  EXPECT_NEAR(band_power(spectrum, 0.2, 0.3), 0.3 * 0.3 / 2, 1e-5);
  EXPECT_NEAR(band_power(spectrum, 0, 1), 0.3 * 0.3 / 2, 1e-5);
  EXPECT_LT(band_power(spectrum, 0, 0.2), 1e-6);
}

// Tests of above_nyquist with waves whose aliases are known.

Score above_nyquist_of(const LinearImage& reference, const LinearImage& test) {
  const Choice choice = choose_metric(metrics(), "above_nyquist");
  const Picture a = make_picture(reference), b = make_picture(test);
  return *choice.metric->measure({&a, 1}, {&b, 1}, choice.settings);
}

/// Two waves, of 0.1 and of 0.8 cycles per pixel of the test, sampled at n × n points per pixel.
LinearImage two_waves(int n, double low_amplitude, double high_amplitude) {
  return make_chart(96 * n, 80 * n, [=](int x, int y) {
    const double px = (x + 0.5) / n, py = (y + 0.5) / n;
    return grey(0.5 + low_amplitude * cos_pi(2 * 0.1 * (0.8 * px + 0.6 * py) + 0.3) +
                high_amplitude * cos_pi(2 * (0.64 * px + 0.48 * py) + 0.7));
  });
}

TEST(AboveNyquist, FindsThePowerOfAnAlias) {
  const Score score = above_nyquist_of(two_waves(4, 0.2, 0.05), two_waves(1, 0.2, 0.05));
  EXPECT_NEAR(score.value, 20 * std::log10(0.05 / 0.2), 0.05);
  EXPECT_NEAR(score.more[2].value, 0.05 * 0.05 / (0.05 * 0.05 + 0.2 * 0.2), 1e-3);
  EXPECT_NEAR(score.more[1].value, 1, 1e-3);
}

TEST(AboveNyquist, BlurIsNotAnAlias) {
  const Score score = above_nyquist_of(two_waves(4, 0.2, 0.05), two_waves(1, 0.1, 0));
  EXPECT_LT(score.value, -60);
  EXPECT_NEAR(score.more[1].value, 0.5, 1e-3);
  EXPECT_NEAR(score.more[0].value, 20 * std::log10(0.5), 0.01);
}

TEST(AboveNyquist, AReferenceOfTheSameSizeHasNone) {
  const Score score = above_nyquist_of(two_waves(1, 0.2, 0), two_waves(1, 0.2, 0));
  EXPECT_EQ(score.value, -std::numeric_limits<double>::infinity());
  EXPECT_NEAR(score.more[2].value, 0, 1e-9);
}

}  // namespace
}  // namespace zoneplate::metrics
