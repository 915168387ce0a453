// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/fourier.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/signal/fourier/fourier_plan.h"

namespace zoneplate {
namespace {

using LongComplex = std::complex<long double>;

double noise(int i, std::uint32_t seed) { return 2.0 * unit_float(hash(static_cast<std::uint32_t>(i), seed)) - 1.0; }

std::vector<Complex> complex_noise(int n) {
  std::vector<Complex> x;
  for (int i = 0; i < n; ++i) x.emplace_back(noise(i, 1), noise(i, 2));
  return x;
}

Plane<float> noise_plane(int w, int h) {
  Plane<float> p(w, h);
  for (int i = 0; float& v : p.values()) v = static_cast<float>(noise(i++, 3));
  return p;
}

// The definition in long double: bins 0, every, 2 every ... below `bins` of a line whose elements are `step` apart.
class DirectTransform {
 public:
  explicit DirectTransform(int n) : n_(static_cast<std::size_t>(n)) {
    const long double turn = 2 * std::acos(-1.0L);
    for (std::size_t k = 0; k < n_; ++k) {
      const long double a = turn * static_cast<long double>(k) / static_cast<long double>(n);
      root_.emplace_back(std::cos(a), -std::sin(a));
    }
  }
  void operator()(LongComplex* data, std::size_t step, std::size_t bins, std::size_t every = 1) const {
    std::vector<LongComplex> line(bins);
    for (std::size_t k = 0; k < bins; k += every) {
      long double re = 0, im = 0;
      for (std::size_t j = 0, at = 0; j < n_; ++j) {
        const LongComplex x = data[j * step], w = root_[at];
        re += x.real() * w.real() - x.imag() * w.imag();
        im += x.real() * w.imag() + x.imag() * w.real();
        at += k;
        if (at >= n_) at -= n_;
      }
      line[k] = {re, im};
    }
    for (std::size_t k = 0; k < bins; ++k) data[k * step] = line[k];
  }

 private:
  std::size_t n_;
  std::vector<LongComplex> root_;
};

double as_double(long double x) { return static_cast<double>(x); }

class FourierOfSize : public testing::TestWithParam<int> {};

std::vector<int> sizes() {
  std::vector<int> all;
  for (int n = 1; n <= 64; ++n) all.push_back(n);
  for (int n : {97, 243, 625, 31 * 29, 997, 1000, 1024, 37 * 32}) all.push_back(n);
  return all;
}

TEST_P(FourierOfSize, AgreesWithTheDefinitionInLongDouble) {
  const int n = GetParam();
  const auto x = complex_noise(n);
  std::vector<LongComplex> direct(x.begin(), x.end());
  const DirectTransform transform(n);
  transform(direct.data(), 1, x.size());
  long double greatest = 0;
  for (const LongComplex& z : direct) greatest = std::max(greatest, std::abs(z));

  const auto spectrum = fourier(x);
  const auto back = inverse_fourier(spectrum);
  double energy = 0, spectral = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    EXPECT_LE(as_double(std::abs(LongComplex(spectrum[k]) - direct[k])), 4e-15 * as_double(greatest)) << k;
    EXPECT_LE(std::abs(back[k] - x[k]), 4e-15);
    energy += std::norm(x[k]), spectral += std::norm(spectrum[k]);
  }
  EXPECT_NEAR(spectral / n / energy, 1, 1e-14);
}

TEST_P(FourierOfSize, RealSignalsGiveHalfTheBins) {
  const int n = GetParam();
  std::vector<double> x;
  std::vector<Complex> z;
  for (int i = 0; i < n; ++i) x.push_back(noise(i, 7)), z.emplace_back(x.back(), 0);
  const auto half = fourier(x);
  const auto full = fourier(z);
  ASSERT_EQ(half.size(), x.size() / 2 + 1);
  for (std::size_t k = 0; k < half.size(); ++k) EXPECT_EQ(half[k], full[k]);
  const auto back = inverse_fourier(half, n);
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(back[k], x[k], 4e-15);
}

INSTANTIATE_TEST_SUITE_P(Sizes, FourierOfSize, testing::ValuesIn(sizes()));

class FourierOfPlane : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(FourierOfPlane, AgreesWithTheDefinitionInLongDouble) {
  const auto [w, h] = GetParam();
  const auto plane = noise_plane(w, h);
  const Spectrum spectrum = fourier(plane);
  Plane<Complex> whole(w, h);
  for (std::size_t i = 0; i < plane.values().size(); ++i) whole.values()[i] = static_cast<double>(plane.values()[i]);
  const Plane<Complex> full = fourier(whole);

  // Rows, then columns, is the double sum of the definition, in an order that takes seconds and not hours. The plane is
  // real, so that the bins with kx <= w / 2 determine the others. Every third kx covers every lane of the transform;
  // Parseval's theorem and the inverse below check all other bins.
  std::vector<LongComplex> direct;
  for (float v : plane.values()) direct.emplace_back(static_cast<long double>(v));
  const DirectTransform rows(w), columns(h);
  const auto width = static_cast<std::size_t>(w), height = static_cast<std::size_t>(h), bins = width / 2 + 1;
  const std::size_t every = w > 100 ? 3 : 1;
  parallel_for(height, [&](std::size_t y) { rows(direct.data() + y * width, 1, bins, every); });
  parallel_for((bins + every - 1) / every, [&](std::size_t x) { columns(direct.data() + x * every, width, height); });

  long double greatest = 0, worst = 0, energy = 0, spectral = 0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const bool is_mirrored = 2 * x > w;
      const auto i = static_cast<std::size_t>(is_mirrored ? (h - y) % h : y) * width +
                     static_cast<std::size_t>(is_mirrored ? w - x : x);
      energy += std::norm(LongComplex(whole(x, y))), spectral += std::norm(LongComplex(full(x, y)));
      EXPECT_LE(std::abs(spectrum.at(x, y) - full(x, y)), 1e-11);
      if (i % width % every != 0) continue;
      const LongComplex z = is_mirrored ? std::conj(direct[i]) : direct[i];
      greatest = std::max(greatest, std::abs(z));
      worst = std::max(worst, std::abs(LongComplex(spectrum.at(x, y)) - z));
      worst = std::max(worst, std::abs(LongComplex(full(x, y)) - z));
    }
  EXPECT_LE(as_double(worst), 1e-14 * as_double(greatest));
  EXPECT_NEAR(as_double(spectral / (w * h) / energy), 1, 1e-14);

  const auto back = inverse_fourier(spectrum);
  const auto back_full = inverse_fourier(full);
  for (std::size_t i = 0; i < plane.values().size(); ++i) {
    ASSERT_NEAR(back.values()[i], plane.values()[i], 1e-7);
    ASSERT_LE(std::abs(back_full.values()[i] - whole.values()[i]), 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, FourierOfPlane,
                         testing::Values(std::pair{640, 480}, std::pair{641, 479}, std::pair{1, 1}, std::pair{1, 7},
                                         std::pair{9, 1}, std::pair{2, 3}, std::pair{13, 17}));

TEST(Fourier, AnImpulseIsFlatAndAShiftTurnsThePhase) {
  std::vector<Complex> x(12);
  x[1] = 1;
  const auto spectrum = fourier(x);
  EXPECT_NEAR(spectrum[3].real(), 0, 1e-16);
  EXPECT_NEAR(spectrum[3].imag(), -1, 1e-16);
  for (const Complex& z : spectrum) EXPECT_NEAR(std::abs(z), 1, 1e-15);
}

TEST(Fourier, NothingHasAnEmptySpectrum) {
  EXPECT_TRUE(fourier(std::vector<Complex>{}).empty());
  EXPECT_TRUE(fourier(std::vector<double>{}).empty());
  EXPECT_TRUE(fourier(Plane<float>()).half.empty());
  EXPECT_TRUE(inverse_fourier(fourier(Plane<float>())).empty());
}

TEST(Fourier, GivesTheSameBitsForAnyNumberOfThreads) {
  const auto plane = noise_plane(90, 131);
  const Spectrum once = fourier(plane);
  const auto back_once = inverse_fourier(once);
  for (int threads : {1, 2, 3, 7}) {
    Spectrum again;
    Plane<float> back;
    with_threads(threads, [&] { again = fourier(plane), back = inverse_fourier(again); });
    EXPECT_EQ(again.half, once.half);
    EXPECT_EQ(back, back_once);
  }
}

// All machines and compilers give the same bits: a hash of a fixed spectrum.
TEST(Fourier, GivesTheBitsThatItAlwaysGave) {
  std::uint64_t bits = 14695981039346656037u;
  for (int n : {480, 641, 1000, 1024})
    for (const Complex& z : fourier(complex_noise(n)))
      for (double part : {z.real(), z.imag()}) bits = (bits ^ std::bit_cast<std::uint64_t>(part)) * 1099511628211u;
  EXPECT_EQ(bits, 3869268571764398285u);
}

TEST(Fourier, FastSizesHaveSmallFactors) {
  EXPECT_EQ(fast_size(0), 1u);
  EXPECT_EQ(fast_size(7), 8u);
  EXPECT_EQ(fast_size(1021), 1024u);
  EXPECT_EQ(fast_size(1000), 1000u);
}

}  // namespace
}  // namespace zoneplate
