// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/spectrum.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/signal/noise_for_test.h"

namespace zoneplate {
namespace {

TEST(Spectrum, PicturesShowEveryBinAtItsPlace) {
  for (const auto& [w, h] : {std::pair{8, 6}, {7, 5}, {8, 5}, {1, 4}, {2, 1}, {1, 1}}) {
    const Spectrum spectrum = fourier(noise_plane(w, h));
    const auto magnitude = centred_log_magnitude(spectrum, 100);
    const auto phase = centred_phase(spectrum);
    double peak = 0;
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) peak = std::max(peak, std::abs(spectrum.at(x, y)));
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        const Complex z = spectrum.at(x - w / 2, y - h / 2);
        EXPECT_NEAR(magnitude(x, y), std::max(0.0, 1 + 20 * std::log10(std::abs(z) / peak) / 100), 1e-6);
        // Compares cosines, because -π and π are the same angle.
        EXPECT_NEAR(std::cos(phase(x, y) - std::arg(z)), 1, 1e-6) << x << " " << y << " of " << w << " " << h;
      }
  }
}

TEST(Spectrum, NothingAndBlackHaveDarkPictures) {
  EXPECT_TRUE(centred_log_magnitude(fourier(Plane<float>())).empty());
  EXPECT_EQ(centred_log_magnitude(fourier(Plane<float>(5, 4))), Plane<float>(5, 4));
  EXPECT_EQ(energy_between(fourier(Plane<float>()), 0, 1), 0.0);
}

TEST(Spectrum, EnergyIsParsevalsAndAWaveLiesInItsRing) {
  for (const auto& [w, h] : {std::pair{40, 32}, {41, 31}}) {
    const Plane<float> plane = noise_plane(w, h);
    double square = 0;
    for (float v : plane.values()) square += static_cast<double>(v) * static_cast<double>(v);
    const Spectrum spectrum = fourier(plane);
    EXPECT_NEAR(energy_between(spectrum, 0, 1), square / (w * h), 1e-12);
    EXPECT_NEAR(energy_between(spectrum, 0, 0.3) + energy_between(spectrum, 0.3, 1), square / (w * h), 1e-12);
    const RadialProfile profile = radial_profile(spectrum, 10);
    double total = 0;
    std::int64_t bins = 0;
    for (std::size_t i = 0; i < profile.power.size(); ++i)
      total += profile.power[i] * static_cast<double>(profile.bins[i]), bins += profile.bins[i];
    EXPECT_EQ(bins, w * h);
    EXPECT_NEAR(total, square / (w * h), 1e-12);
  }
  Plane<float> wave(40, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) wave(x, y) = static_cast<float>(std::cos(2 * M_PI * (6 * x + 8 * y) / 40));
  const RadialProfile profile = radial_profile(fourier(wave), 10);  // frequency 10/40 = 0.25 is in ring 5
  for (std::size_t i = 0; i < profile.power.size(); ++i)
    EXPECT_NEAR(profile.power[i] * static_cast<double>(profile.bins[i]), i == 5 ? 0.5 : 0.0, 1e-7) << i;
}

TEST(Spectrum, GivesTheSameBitsForAnyNumberOfThreads) {
  const Spectrum spectrum = fourier(noise_plane(50, 130));
  const auto magnitude = centred_log_magnitude(spectrum);
  const auto phase = centred_phase(spectrum);
  const auto profile = radial_profile(spectrum, 20);
  const double energy = energy_between(spectrum, 0.1, 0.4);
  for (int threads : {1, 2, 3, 7})
    with_threads(threads, [&] {
      EXPECT_EQ(centred_log_magnitude(spectrum), magnitude);
      EXPECT_EQ(centred_phase(spectrum), phase);
      EXPECT_EQ(radial_profile(spectrum, 20).power, profile.power);
      EXPECT_EQ(energy_between(spectrum, 0.1, 0.4), energy);
    });
}

// All machines and compilers give the same bits.
TEST(Spectrum, GivesTheBitsThatItAlwaysGave) {
  std::uint64_t bits = 14695981039346656037u;
  const Spectrum spectrum = fourier(noise_plane(45, 36));
  const auto magnitude = centred_log_magnitude(spectrum), phase = centred_phase(spectrum);
  for (const auto* plane : {&magnitude, &phase})
    for (const float v : plane->values()) bits = (bits ^ std::bit_cast<std::uint32_t>(v)) * 1099511628211u;
  EXPECT_EQ(bits, 11746575194876733232u);
}

}  // namespace
}  // namespace zoneplate
