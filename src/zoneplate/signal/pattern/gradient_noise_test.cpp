// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/pattern/gradient_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using F = scalar::Float;
using Point = Vector<F>;

Point point(float x, float y, float z) { return {F(x), F(y), F(z)}; }
Point random_point(std::uint32_t i, float range) {
  const auto coordinate = [&](std::uint32_t c) { return (unit_float(hash(i, c)) - 0.5f) * range; };
  return point(coordinate(0), coordinate(1), coordinate(2));
}
float noise(Point p) { return gradient_noise<F>(p).value.v; }

TEST(GradientNoise, HasThePublishedValues) {
  // noise(3.14, 42, 7) of the reference implementation of 2002.
  EXPECT_NEAR(noise(point(3.14f, 42, 7)), 0.13691995878, 2e-6);
  std::vector<int> once(noise_tables.permutation, noise_tables.permutation + 256);
  std::sort(once.begin(), once.end());
  for (int i = 0; i < 256; ++i) EXPECT_EQ(once[static_cast<std::size_t>(i)], i);
}

TEST(GradientNoise, IsZeroAtLatticePointsAndPeriodic) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Point p = random_point(i, 500);
    EXPECT_EQ(noise({floor(p.x), floor(p.y), floor(p.z)}), 0);
    const Point q{F(std::round(p.x.v * 64) / 64), F(std::round(p.y.v * 64) / 64), F(std::round(p.z.v * 64) / 64)};
    EXPECT_EQ(noise(q), noise(q + point(256, -512, 768)));
    EXPECT_LE(std::abs(noise(p)), 1.04f);
  }
}

TEST(GradientNoise, GradientEqualsDifferences) {
  constexpr float h = 1.0f / 256;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Point p = random_point(i, 20);
    const Point gradient = gradient_noise<F>(p).gradient;
    const auto difference = [&](Point way) { return (noise(p + way) - noise(p - way)) / (2 * h); };
    EXPECT_NEAR(gradient.x.v, difference(point(h, 0, 0)), 2e-3f);
    EXPECT_NEAR(gradient.y.v, difference(point(0, h, 0)), 2e-3f);
    EXPECT_NEAR(gradient.z.v, difference(point(0, 0, h)), 2e-3f);
  }
}

TEST(GradientNoise, CoordinatesThatAreNotFiniteGiveNumbers) {
  for (const float x : {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                        std::numeric_limits<float>::quiet_NaN(), 3e38f, -1e-30f})
    EXPECT_TRUE(std::isfinite(noise(point(x, 0.5f, x)))) << x;
}

TEST(FractalNoise, TurbulenceTendsToItsMean) {
  double sum = 0;
  constexpr int count = 100000;
  for (std::uint32_t i = 0; i < count; ++i)
    sum += fractal_noise<F>(random_point(i, 200), F(0.0f), {3, 0.5f}, true).value.v;
  EXPECT_NEAR(sum / count, fractal_noise<F>(point(0.3f, 0.4f, 0.5f), F(100.0f), {3, 0.5f}, true).value.v, 3e-3);
  EXPECT_NEAR(fractal_noise<F>(point(0.3f, 0.4f, 0.5f), F(100.0f), {3, 0.5f}, false).value.v, 0, 1e-6f);
}

}  // namespace
}  // namespace zoneplate
