// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/periodic_smooth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/math/random.h"
#include "zoneplate/signal/border.h"
#include "zoneplate/signal/fourier/spectrum.h"

namespace zoneplate {
namespace {

Plane<float> ramp_with_noise(int w, int h) {
  Plane<float> p(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      p(x, y) = 0.02f * static_cast<float>(x) + 0.03f * static_cast<float>(y) +
                0.1f * unit_float(hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
  return p;
}

TEST(PeriodicSmooth, ThePartsAddUpAndTheSmoothPartHasNoMean) {
  for (const auto& [w, h] : {std::pair{40, 30}, {31, 17}, {1, 9}, {2, 2}, {1, 1}}) {
    const Plane<float> plane = ramp_with_noise(w, h);
    const PeriodicSmooth parts = split_periodic_smooth(plane);
    double sum = 0;
    for (std::size_t i = 0; i < plane.values().size(); ++i) {
      EXPECT_NEAR(parts.periodic.values()[i] + parts.smooth.values()[i], plane.values()[i], 2.5e-7);
      sum += static_cast<double>(parts.smooth.values()[i]);
    }
    EXPECT_NEAR(sum, 0, 1e-5);
  }
  EXPECT_TRUE(split_periodic_smooth(Plane<float>()).periodic.empty());
}

// By definition, the smooth part is harmonic inside, and at an edge its periodic Laplacian is the jump.
TEST(PeriodicSmooth, TheLaplacianOfTheSmoothPartIsTheJump) {
  const int w = 24, h = 18;
  const Plane<float> u = ramp_with_noise(w, h);
  const Plane<float> s = split_periodic_smooth(u).smooth;
  const auto at = [](const Plane<float>& p, int x, int y) {
    return static_cast<double>(p(border_index(x, w, Border::Wrap), border_index(y, h, Border::Wrap)));
  };
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double laplacian = at(s, x - 1, y) + at(s, x + 1, y) + at(s, x, y - 1) + at(s, x, y + 1) - 4 * at(s, x, y);
      double jump = 0;
      if (x == 0) jump += at(u, -1, y) - at(u, x, y);
      if (x == w - 1) jump += at(u, w, y) - at(u, x, y);
      if (y == 0) jump += at(u, x, -1) - at(u, x, y);
      if (y == h - 1) jump += at(u, x, h) - at(u, x, y);
      EXPECT_NEAR(laplacian, jump, 2e-6) << x << " " << y;
    }
}

TEST(PeriodicSmooth, APeriodicPlaneIsLeftAsItIsAndTheCrossOfARampGoesAway) {
  Plane<float> wave(32, 32), ramp(32, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      wave(x, y) = static_cast<float>(std::cos(2 * M_PI * 3 * (x + 0.5) / 32));
      ramp(x, y) = static_cast<float>(x + y);
    }
  // A cosine that is even about its edges has no jumps.
  const PeriodicSmooth of_wave = split_periodic_smooth(wave);
  for (float v : of_wave.smooth.values()) EXPECT_NEAR(v, 0, 1e-6);
  const double before = energy_between(fourier(ramp), 0.2, 1);
  const double after = energy_between(fourier(split_periodic_smooth(ramp).periodic), 0.2, 1);
  EXPECT_LT(after, before / 20);
}

}  // namespace
}  // namespace zoneplate
