// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/series.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

TEST(Series, HarmonicsAreTheIntegralsOfTheWaves) {
  for (const Wave wave : {Wave::Square, Wave::Sawtooth, Wave::Triangle}) {
    EXPECT_EQ(parse_wave(name_of(wave)), wave);
    for (int n = 1; n <= 9; ++n) {
      // b = 2 ∫ wave(x) sin(2πnx) dx by the midpoint rule, whose error is the jump times 1/N².
      double b = 0, a = 0;
      const int steps = 20000;
      for (int i = 0; i < steps; ++i) {
        const double x = (i + 0.5) / steps;
        b += 2 * wave_value(wave, x) * std::sin(2 * M_PI * n * x) / steps;
        a += 2 * wave_value(wave, x) * std::cos(2 * M_PI * n * x) / steps;
      }
      EXPECT_NEAR(harmonic(wave, n), b, 1e-6) << name_of(wave) << n;
      EXPECT_NEAR(a, 0, 1e-9);
    }
    for (double x : {0.1, 0.3, 0.6, -0.2}) EXPECT_NEAR(partial_sum(wave, 2001, x), wave_value(wave, x), 2e-3);
  }
  EXPECT_THROW(parse_wave("sine"), Error);
}

TEST(Series, TheOvershootOfGibbsStays) {
  for (int highest : {15, 101, 1001}) {
    // The first maximum is half a period of the last harmonic from the jump.
    const double top = partial_sum(Wave::Square, highest, 0.5 / (highest + 1));
    EXPECT_NEAR(top, 1.17898, highest == 15 ? 5e-3 : 1e-4);
  }
}

TEST(Series, WavesOnePeriodLaterAndAtTheirJumps) {
  EXPECT_EQ(wave_value(Wave::Square, 0), 0.0);
  EXPECT_EQ(wave_value(Wave::Square, 3.25), 1.0);
  EXPECT_EQ(wave_value(Wave::Square, -0.25), -1.0);
  EXPECT_EQ(wave_value(Wave::Triangle, 0.25), 1.0);
  EXPECT_EQ(wave_value(Wave::Triangle, 0.75), -1.0);
  EXPECT_EQ(wave_value(Wave::Sawtooth, 0.75), 0.5);
}

TEST(Series, FrequenciesThatSamplesCannotTellApart) {
  EXPECT_NEAR(apparent_frequency(0.9, 1), -0.1, 1e-15);
  EXPECT_EQ(apparent_frequency(0.5, 1), 0.5);
  EXPECT_EQ(apparent_frequency(-0.5, 1), 0.5);
  EXPECT_EQ(apparent_frequency(7, 10), -3.0);
  EXPECT_EQ(folded_frequency(13, 10), 3.0);
  EXPECT_EQ(folded_frequency(20, 10), 0.0);
  for (const double f : {0.3, 4.0, 7.7, 23.1}) {
    const double rate = 10;
    for (int i = 0; i < 50; ++i) {
      EXPECT_NEAR(std::cos(2 * M_PI * f * i / rate), std::cos(2 * M_PI * folded_frequency(f, rate) * i / rate), 1e-11);
      EXPECT_NEAR(std::sin(2 * M_PI * f * i / rate), std::sin(2 * M_PI * apparent_frequency(f, rate) * i / rate),
                  1e-11);
    }
  }
  EXPECT_EQ(aliases_of(3, 10, 30), (std::vector<double>{3, 7, 13, 17, 23, 27}));
  EXPECT_EQ(aliases_of(10, 10, 30), (std::vector<double>{10, 20, 30}));
  EXPECT_EQ(aliases_of(5, 10, 30), (std::vector<double>{5, 15, 25}));
}

TEST(Series, ShutterAndCopies) {
  EXPECT_NEAR(shutter_contrast(0.9), 0.10929, 1e-5);
  EXPECT_EQ(shutter_contrast(0), 1.0);
  const Band band = overlap_of_copies(6, 10);
  EXPECT_EQ(band.low, 4.0);
  EXPECT_EQ(band.high, 6.0);
  EXPECT_GE(overlap_of_copies(4, 10).low, overlap_of_copies(4, 10).high);
}

}  // namespace
}  // namespace zoneplate
