// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/pattern/pattern.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/signal/filter/aliasing.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate {
namespace {

Plane<float> red_of(const LinearImage& image) {
  Plane<float> out(image.width(), image.height());
  for (std::size_t i = 0; i < out.values().size(); ++i) out.values()[i] = image.values()[i].r;
  return out;
}

TEST(Pattern, EveryOneIsMadeWithinRange) {
  for (const PatternEntry& entry : patterns()) {
    const LinearImage image = make_pattern(std::string(entry.name) + ":size=33");
    EXPECT_TRUE(is_pattern(entry.name));
    ASSERT_EQ(image.width(), 33);
    ASSERT_EQ(image.height(), 33);
    float least = 2, greatest = -1;
    for (const Linear& c : image.values()) {
      EXPECT_EQ(c.a, 1.0f);
      least = std::min({least, c.r, c.g, c.b}), greatest = std::max({greatest, c.r, c.g, c.b});
    }
    EXPECT_GE(least, 0.0f) << entry.name;
    EXPECT_LE(greatest, 1.0f) << entry.name;
    EXPECT_GT(greatest - least, 0.3f) << entry.name;
  }
}

TEST(Pattern, WavesAreTheirFormulas) {
  EXPECT_EQ(red_of(make_pattern("zone-plate:size=65")), zone_plate(65));
  const LinearImage sine = make_pattern("sine:size=40,frequency=0.3,angle=30");
  const LinearImage sweep = make_pattern("sweep:size=40");
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const double phase = 2 * M_PI * 0.3 * (x * std::cos(M_PI / 6) + y * std::sin(M_PI / 6));
      EXPECT_NEAR(sine(x, y).g, 0.5 + 0.5 * std::cos(phase), 1e-6);
      EXPECT_NEAR(sweep(x, y).b, 0.5 + 0.5 * std::cos(M_PI * (x + 0.5) * (x + 0.5) / 80), 1e-6);
    }
}

TEST(Pattern, TheImpulseHasAFlatSpectrum) {
  const Spectrum spectrum = fourier(red_of(make_pattern("impulse:size=16")));
  for (const Complex& z : spectrum.half.values()) EXPECT_NEAR(std::abs(z), 1, 1e-12);
}

TEST(Pattern, AStarRepeatsWithItsSpokes) {
  // With four spokes, the image is invariant under a quarter turn.
  const LinearImage star = make_pattern("star:size=31,spokes=4");
  for (int y = 0; y < 31; ++y)
    for (int x = 0; x < 31; ++x) EXPECT_NEAR(star(x, y).r, star(30 - y, x).r, 1e-6);
}

TEST(Pattern, NoiseIsItsSeeds) {
  EXPECT_EQ(make_pattern("noise:size=16,seed=3"), make_pattern("noise:size=16,seed=3"));
  EXPECT_NE(make_pattern("noise:size=16,seed=3"), make_pattern("noise:size=16,seed=4"));
  const LinearImage noise = make_pattern("noise:size=128");
  double mean = 0;
  for (const Linear& c : noise.values()) mean += static_cast<double>(c.r) / (128 * 128);
  EXPECT_NEAR(mean, 0.5, 0.01);  // four standard deviations of the mean
}

TEST(Pattern, RefusesWhatItDoesNotKnow) {
  EXPECT_FALSE(is_pattern("zone-plate.png"));
  EXPECT_TRUE(is_pattern("zone-plate:size=3"));
  EXPECT_THROW(make_pattern("plaid"), Error);
  EXPECT_THROW(make_pattern("sine:size=1"), Error);
  EXPECT_THROW(make_pattern("sine:width=10"), Error);
}

}  // namespace
}  // namespace zoneplate
