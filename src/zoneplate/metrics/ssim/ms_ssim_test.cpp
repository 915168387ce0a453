// SPDX-License-Identifier: Apache-2.0
// MS-SSIM compared with an independent implementation of the paper: whole windows instead of separable ones, loops over
// pixels.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/metrics/ssim/ssim.h"

namespace zoneplate::metrics {
namespace {

using Exponents = std::array<double, 5>;
constexpr Exponents published = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};  // section 4, from fine to coarse

struct Pair {
  Plane<double> reference, test;
};

// Codes of a chart whose waves become finer away from its corner, in integer arithmetic.
double code(int x, int y) { return ((7 * x * x + 13 * y * y + 5 * x * y) / 64 + 2 * x) % 256; }

// The distortions: noise, blur of 3 x 3 pixels, and half the contrast on coarse squares.
double distorted(int kind, int x, int y) {
  if (kind == 0) return std::clamp(code(x, y) + (37 * x + 91 * y + x * y) % 41 - 20, 0.0, 255.0);
  if (kind == 2) return 0.5 * code(x, y) + ((x / 16 + y / 16) % 2 == 1 ? 90 : 10);
  double sum = 0;
  for (int j = -1; j <= 1; ++j)
    for (int i = -1; i <= 1; ++i) sum += code(std::abs(x + i), std::abs(y + j));
  return sum / 9;
}

Pair made_pair(int kind) {
  constexpr std::array<std::array<int, 2>, 3> sizes = {{{192, 176}, {177, 191}, {203, 183}}};
  const auto [width, height] = sizes[static_cast<std::size_t>(kind)];
  Pair pair{Plane<double>(width, height), Plane<double>(width, height)};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      pair.reference(x, y) = code(x, y) / 255;
      pair.test(x, y) = distorted(kind, x, y) / 255;
    }
  return pair;
}

// The means of luminance × contrast-structure and of contrast-structure, over all windows inside the image.
struct Means {
  double both = 0, contrast = 0;
};

Means means_of(const Pair& pair) {
  double window[11][11], total = 0;
  for (int j = 0; j < 11; ++j)
    for (int i = 0; i < 11; ++i)
      total += window[j][i] = std::exp(-((i - 5) * (i - 5) + (j - 5) * (j - 5)) / (2 * 1.5 * 1.5));
  Means sum;
  const int across = pair.reference.width() - 10, down = pair.reference.height() - 10;
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x) {
      double mean_a = 0, mean_b = 0, variance_a = 0, variance_b = 0, covariance = 0;
      for (int j = 0; j < 11; ++j)
        for (int i = 0; i < 11; ++i) {
          const double w = window[j][i] / total, a = pair.reference(x + i, y + j), b = pair.test(x + i, y + j);
          mean_a += w * a, mean_b += w * b;
          variance_a += w * a * a, variance_b += w * b * b, covariance += w * a * b;
        }
      variance_a -= mean_a * mean_a, variance_b -= mean_b * mean_b, covariance -= mean_a * mean_b;
      const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
      const double luminance = (2 * mean_a * mean_b + c1) / (mean_a * mean_a + mean_b * mean_b + c1);
      const double contrast = (2 * covariance + c2) / (variance_a + variance_b + c2);
      sum.both += luminance * contrast, sum.contrast += contrast;
    }
  const double count = static_cast<double>(across) * down;
  return {sum.both / count, sum.contrast / count};
}

Plane<double> halved(const Plane<double>& image) {
  Plane<double> half(image.width() / 2, image.height() / 2);
  for (int y = 0; y < half.height(); ++y)
    for (int x = 0; x < half.width(); ++x)
      half(x, y) = 0.25 * (image(2 * x, 2 * y) + image(2 * x + 1, 2 * y) + image(2 * x, 2 * y + 1) +
                           image(2 * x + 1, 2 * y + 1));
  return half;
}

// Equation 7: contrast-structure of the first four scales, and luminance × contrast-structure of the fifth.
std::array<double, 5> factors_of(Pair pair) {
  std::array<double, 5> factors{};
  for (std::size_t scale = 0; scale < 5; ++scale) {
    const Means means = means_of(pair);
    factors[scale] = scale == 4 ? means.both : means.contrast;
    pair = {halved(pair.reference), halved(pair.test)};
  }
  return factors;
}

double product(const std::array<double, 5>& factors, const Exponents& exponents) {
  double result = 1;
  for (std::size_t scale = 0; scale < 5; ++scale) result *= std::pow(factors[scale], exponents[scale]);
  return result;
}

// The expected values come from a third implementation, in Python, of the same formulas.
TEST(MsSsim, EqualsAnIndependentProgram) {
  constexpr std::array<double, 3> from_python = {0.9819516113383528, 0.8364491952901896, 0.1872875389401846};
  for (int kind = 0; kind < 3; ++kind) {
    const Pair pair = made_pair(kind);
    const double value = multiscale_similarity(pair.reference, pair.test);
    EXPECT_NEAR(value, product(factors_of(pair), published), 1e-12) << kind;
    EXPECT_NEAR(value, from_python[static_cast<std::size_t>(kind)], 1e-10) << kind;
  }
}

// The images of the test above distinguish the exponents: exchanging any two of them changes a value.
TEST(MsSsim, ExponentsInAnyOtherOrderWouldBeNoticed) {
  std::array<std::array<double, 5>, 3> factors{};
  for (int kind = 0; kind < 3; ++kind) {
    factors[static_cast<std::size_t>(kind)] = factors_of(made_pair(kind));
    for (const double f : factors[static_cast<std::size_t>(kind)]) EXPECT_GT(f, 0.01);
  }
  std::array<std::size_t, 5> order = {0, 1, 2, 3, 4};
  while (std::ranges::next_permutation(order).found) {
    Exponents exponents{};
    for (std::size_t scale = 0; scale < 5; ++scale) exponents[scale] = published[order[scale]];
    double greatest = 0;
    for (const auto& f : factors)
      greatest = std::max(greatest, std::abs(product(f, exponents) - product(f, published)));
    EXPECT_GT(greatest, 1e-3) << order[0] << order[1] << order[2] << order[3] << order[4];
  }
}

}  // namespace
}  // namespace zoneplate::metrics
