// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/ssim/ssim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/metrics/charts_for_test.h"
#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

Plane<double> constant(double value) { return Plane<double>(16, 12, value); }

Similarity similarity_of_chart(int which) {
  const ChartPair pair = chart_pair(which);
  return structural_similarity(luma_plane(as_codes(pair.reference)), luma_plane(as_codes(pair.test)));
}

TEST(Ssim, OfConstantsIsTheLuminanceTermAlone) {
  // Without variance, contrast-structure is C2 / C2.
  const Similarity s = structural_similarity(constant(0.25), constant(0.75));
  const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
  EXPECT_NEAR(s.ssim, expected, 1e-12);
  EXPECT_NEAR(s.contrast, 1, 1e-12);
}

TEST(Ssim, PublishedValues) {
  EXPECT_NEAR(similarity_of_chart(0).ssim, 0.988870, 1e-6);
  EXPECT_NEAR(similarity_of_chart(1).ssim, 0.017831, 1e-6);
  EXPECT_NEAR(similarity_of_chart(3).ssim, 0.660097, 1e-6);
}

TEST(Ssim, OneWindowByHand) {
  // An 11 × 11 image has one window inside; a single pixel at its centre has the weight w = (the Gaussian's centre
  // tap)².
  Plane<double> a(11, 11, 0.0), b(11, 11, 0.0);
  a(5, 5) = 1;
  b(5, 5) = 0.5;
  double sum = 0;
  for (int i = -5; i <= 5; ++i) sum += std::exp(-i * i / 4.5);
  const double w = 1 / (sum * sum), c1 = 1e-4, c2 = 9e-4;
  const double luminance = (2 * w * w / 2 + c1) / (w * w + w * w / 4 + c1);
  const double contrast = (2 * (w / 2 - w * w / 2) + c2) / ((w - w * w) + (w / 4 - w * w / 4) + c2);
  const Similarity s = structural_similarity(a, b);
  EXPECT_NEAR(s.ssim, luminance * contrast, 1e-12);
  EXPECT_NEAR(s.contrast, contrast, 1e-12);
  EXPECT_NEAR(s.map(5, 5), luminance * contrast, 1e-7);
}

// Computed by a Python implementation of the paper's formula that sums whole windows. The images have integer values.
TEST(Ssim, UniformWindowsAsTheFormulaSays) {
  const auto code = [](int x, int y) { return ((7 * x * x + 13 * y * y + 5 * x * y) / 64 + 2 * x) % 256; };
  const auto noisy = [&](int x, int y) { return std::clamp(code(x, y) + (37 * x + 91 * y + x * y) % 41 - 20, 0, 255); };
  Plane<double> a(24, 20), b(24, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 24; ++x) a(x, y) = code(x, y) / 255.0, b(x, y) = noisy(x, y) / 255.0;
  const struct {
    SimilarityWindow window;
    double ssim;
  } expected[] = {{{7, true}, 0.7560892134975208},
                  {{7, false}, 0.756665985733545},
                  {{8, true}, 0.7965766986483606},
                  {{2, false}, 0.44530943939238316},
                  {{11, true}, 0.8783639258302577}};
  for (const auto& [window, ssim] : expected)
    EXPECT_NEAR(structural_similarity(a, b, window).ssim, ssim, 1e-12) << window.side << ' ' << window.is_unbiased;
}

TEST(Ssim, OfColoursIsTheMeanOfTheThree) {
  const ChartPair pair = chart_pair(2);  // only red differs
  const Picture a = make_picture(as_codes(pair.reference)), b = make_picture(as_codes(pair.test));
  const auto measure = [&](const char* text) {
    const Choice choice = choose_metric(metrics(), text);
    return choice.metric->measure({&a, 1}, {&b, 1}, choice.settings)->value;
  };
  const auto red = [](const Picture& p) { return luma_plane(p.display, {1, 0, 0}); };
  EXPECT_NEAR(measure("ssim:rgb=1"), (structural_similarity(red(a), red(b)).ssim + 2) / 3, 1e-12);
  EXPECT_NE(measure("ssim:rgb=1"), measure("ssim"));
  EXPECT_NE(measure("ssim:window=7,unbiased=1"), measure("ssim:window=7"));
}

TEST(MsSsim, OfConstantsIsTheLuminanceOfTheLastScale) {
  const Plane<double> dark(177, 190, 0.25), light(177, 190, 0.75);
  const double luminance = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
  EXPECT_NEAR(multiscale_similarity(dark, light), std::pow(luminance, 0.1333), 1e-12);
}

TEST(MsSsim, ForgivesFineErrorsMoreThanCoarseOnes) {
  Plane<double> flat(192, 192, 0.5), fine = flat, coarse = flat;
  for (int y = 0; y < 192; ++y) {
    for (int x = 0; x < 192; ++x) {
      fine(x, y) += (x + y) % 2 == 0 ? 0.05 : -0.05;
      coarse(x, y) += (x / 16 + y / 16) % 2 == 0 ? 0.05 : -0.05;
    }
  }
  EXPECT_GT(multiscale_similarity(flat, fine), 0.8);
  EXPECT_LT(multiscale_similarity(flat, coarse), 0.5);
}

}  // namespace
}  // namespace zoneplate::metrics
