// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/window.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/signal/fourier/fourier.h"

namespace zoneplate {
namespace {

TEST(Window, EveryWindowIsSymmetricWithItsPeakOfOneInTheMiddle) {
  EXPECT_EQ(windows().size(), 6u);
  for (const WindowEntry& entry : windows()) {
    const Window window = make_window(entry.name);
    EXPECT_EQ(window.name, entry.name);
    EXPECT_NEAR(window.value(0.5), 1, 1e-15) << entry.name;
    for (int n : {1, 2, 7, 64}) {
      const auto w = sampled(window, n);
      for (std::size_t k = 0; k < w.size(); ++k) {
        EXPECT_NEAR(w[k], w[w.size() - 1 - k], 1e-14);
        EXPECT_GT(w[k], -1e-9);
        EXPECT_LE(w[k], 1 + 1e-15);
      }
    }
  }
}

TEST(Window, ValuesGainsAndBandwidthsFromHarrisTable) {
  EXPECT_NEAR(make_window("hann").value(0.25), 0.5, 1e-15);
  EXPECT_NEAR(make_window("hamming").value(0), 0.08, 1e-15);
  EXPECT_NEAR(make_window("blackman").value(0), 0, 1e-15);
  EXPECT_NEAR(make_window("blackman").value(0.25), 0.34, 1e-15);
  EXPECT_EQ(make_window("tukey:alpha=0.5").value(0.3), 1.0);
  EXPECT_NEAR(make_window("tukey:alpha=0.5").value(0.125), 0.5, 1e-15);
  EXPECT_NEAR(make_window("tukey:alpha=1").value(0.1), make_window("hann").value(0.1), 1e-15);
  EXPECT_EQ(make_window("tukey:alpha=0").value(0), 1.0);
  EXPECT_NEAR(make_window("kaiser:beta=0").value(0.1), 1, 1e-15);
  EXPECT_NEAR(make_window("kaiser:beta=6").value(0), 1 / std::cyl_bessel_i(0.0, 6.0), 1e-14);

  const auto gain = [](const char* name) { return coherent_gain(sampled(make_window(name), 512)); };
  const auto noise = [](const char* name) { return noise_bandwidth(sampled(make_window(name), 512)); };
  EXPECT_NEAR(gain("hann"), 0.5, 1e-14);
  EXPECT_NEAR(gain("hamming"), 0.54, 1e-14);
  EXPECT_NEAR(gain("blackman"), 0.42, 1e-14);
  EXPECT_NEAR(noise("none"), 1, 1e-14);
  EXPECT_NEAR(noise("hann"), 1.5, 1e-13);
  EXPECT_NEAR(noise("hamming"), 1.36, 5e-3);
  EXPECT_NEAR(noise("blackman"), 1.73, 5e-3);
}

// The purpose of a window: the spectrum of a wave with a fractional number of periods is small far from its frequency.
TEST(Window, SideLobesFallAsTheTableSays) {
  const auto leak = [](const char* name) {
    const int n = 256;
    const auto w = sampled(make_window(name), n);
    std::vector<double> x;
    for (int i = 0; i < n; ++i) x.push_back(w[static_cast<std::size_t>(i)] * std::cos(2 * M_PI * 40.5 * i / n));
    const auto spectrum = fourier(x);
    double far = 0;
    for (std::size_t k = 60; k < 120; ++k) far = std::max(far, std::abs(spectrum[k]));
    return 20 * std::log10(far / std::abs(spectrum[40]));
  };
  EXPECT_GT(leak("none"), -40);
  EXPECT_LT(leak("hann"), -75);
  EXPECT_LT(leak("hamming"), -45);
  EXPECT_LT(leak("blackman"), -85);
  EXPECT_LT(leak("kaiser"), -80);
}

TEST(Window, APlaneIsWindowedInBothDirections) {
  const Window hann = make_window("hann");
  const auto out = windowed(Plane<float>(4, 3, 2.0f), hann);
  EXPECT_FLOAT_EQ(out(1, 2), static_cast<float>(2 * hann.value(1.5 / 4) * hann.value(2.5 / 3)));
  EXPECT_TRUE(windowed(Plane<float>(), hann).empty());
}

TEST(Window, RefusesUnknownOnes) {
  EXPECT_THROW(make_window("hanning"), Error);
  EXPECT_THROW(make_window("hann:alpha=1"), Error);
  EXPECT_THROW(make_window("tukey:alpha=2"), Error);
}

}  // namespace
}  // namespace zoneplate
