// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/backdrop/backdrop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/backdrop/backdrop_lanes.h"

namespace zoneplate {
namespace {

TEST(Backdrop, AConstantImageStaysConstantAtEveryLevel) {
  const Linear color{0.25f, 3, 1e-3f, 0.75f};
  for (const auto& [w, h] : {std::pair(13, 7), std::pair(64, 64), std::pair(1, 5), std::pair(1, 1)}) {
    const Backdrop backdrop(LinearImage(w, h, color), {});
    const BackdropView view = backdrop.view();
    EXPECT_EQ(view.width[view.levels - 1] * view.height[view.levels - 1], 1);
    for (int k = 0; k < view.levels; ++k)
      for (int i = 0; i < view.width[k] * view.height[k]; ++i) {
        const float* texel = view.texels + 4 * (view.offset[k] + i);
        EXPECT_EQ((Linear{texel[0], texel[1], texel[2], texel[3]}), color) << k << " " << i;
      }
  }
}

TEST(Backdrop, LevelsAreFilteredByBinomialWeights) {
  LinearImage image(8, 8, Linear{0, 0, 0, 0});
  image(4, 2) = {64, 0, 0, 0};
  const Backdrop backdrop(image, {});
  const BackdropView view = backdrop.view();
  // Texel x of the level takes 1 3 3 1 eighths of the columns 2x - 1 to 2x + 2.
  const float expected[4] = {0, 1, 3, 0}, along_y[4] = {1, 3, 0, 0};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_EQ(view.texels[4 * (view.offset[1] + y * 4 + x)], expected[x] * along_y[y]) << x << " " << y;
}

TEST(Backdrop, BlurredLevelsAreLookedUpByTheCubicBSpline) {
  using F = scalar::Float;
  LinearImage image(16, 16, Linear{0, 0, 0, 1});
  for (int x = 0; x < 16; ++x)
    for (int y = 0; y < 16; ++y) image(x, y).r = static_cast<float>(hash(static_cast<std::uint32_t>(16 * y + x)) % 100);
  const Backdrop backdrop(image, {});
  const BackdropView view = backdrop.view();
  const auto texel = [&](int x, int y) {
    const int at = std::clamp(y, 0, 7) * 8 + std::clamp(x, 0, 7);
    return static_cast<double>(view.texels[4 * (view.offset[1] + at)]);
  };
  const auto weight = [](double d) {  // the B-spline at a distance
    d = std::abs(d);
    return d < 1 ? 2.0 / 3 - d * d + d * d * d / 2 : d < 2 ? (2 - d) * (2 - d) * (2 - d) / 6 : 0;
  };
  for (const auto& [px, py] : {std::pair(7.3f, 8.9f), std::pair(0.2f, 15.7f), std::pair(12.0f, 3.5f)}) {
    const double x = px / 2 - 0.5, y = py / 2 - 0.5;
    double expected = 0;
    for (int j = -3; j < 12; ++j)
      for (int i = -3; i < 12; ++i) expected += texel(i, j) * weight(x - i) * weight(y - j);
    const BackdropColor<F> found = backdrop_texels<F>(view, {px, py, scalar::Int(0)}, scalar::Int(1));
    EXPECT_NEAR(found.color.x.v, expected, 1e-3) << px << " " << py;
    EXPECT_NEAR(found.alpha.v, 1, 1e-6);
  }
}

}  // namespace
}  // namespace zoneplate
