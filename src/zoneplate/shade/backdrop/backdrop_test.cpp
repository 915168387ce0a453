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

/// An image of stripes that are an eighth of its width wide.
LinearImage stripes(int width) {
  LinearImage image(width, width, Linear{0, 0, 0, 1});
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x) image(x, y).r = static_cast<float>(x * 8 / width % 2);
  return image;
}

TEST(Backdrop, IsBlurredByTheSamePartOfItsWidthAtEverySize) {
  using F = scalar::Float;
  const Backdrop small(stripes(256), {}), large(stripes(1024), {});
  const auto at = [](const Backdrop& backdrop, float x, float roughness) {
    const BackdropView view = backdrop.view();
    const F place(x * static_cast<float>(view.width[0]));
    return backdrop_color<F>(view, {place, place}, F(roughness)).color.x.v;
  };
  for (const float x : {0.31f, 0.36f, 0.375f, 0.39f, 0.44f}) {
    for (const float roughness : {0.4f, 0.5f, 0.6f, 0.8f, 1.0f})
      EXPECT_NEAR(at(small, x, roughness), at(large, x, roughness), 0.06f) << x << " " << roughness;
    EXPECT_EQ(at(large, x, 0), x < 0.374f ? 0 : x > 0.376f ? 1 : 0.5f) << x;
  }
  EXPECT_NEAR(at(large, 0.3125f, 1), 0.5f, 0.02f);
}

TEST(Backdrop, WhatIsEmptyStaysSharpAndHasNoPartInTheColour) {
  using F = scalar::Float;
  LinearImage image(64, 64, Linear{0, 0, 0, 0});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 20; ++x) image(x, y) = {0.25f, 2, 0, 1};
  const Backdrop walled(image, {}), thin(LinearImage(64, 64, Linear{0.25f, 0.125f, 0, 0.5f}), {});
  const auto at = [](const Backdrop& backdrop, float x, float roughness) {
    return backdrop_color<F>(backdrop.view(), {F(x), F(32), scalar::Int(0)}, F(roughness));
  };
  for (const float roughness : {0.0f, 0.2f, 0.5f, 0.8f, 1.0f}) {
    for (const float x : {0.0f, 10.0f, 19.4f}) {
      EXPECT_EQ(at(walled, x, roughness).alpha.v, 1) << roughness << " " << x;
      EXPECT_NEAR(at(walled, x, roughness).color.x.v, 0.25f, 1e-5f) << roughness << " " << x;
      EXPECT_NEAR(at(walled, x, roughness).color.y.v, 2, 1e-4f) << roughness << " " << x;
    }
    for (const float x : {20.6f, 40.0f, 64.0f}) EXPECT_EQ(at(walled, x, roughness).alpha.v, 0) << roughness << " " << x;
    EXPECT_NEAR(at(thin, 17.3f, roughness).alpha.v, 0.5f, 1e-6f) << roughness;
    EXPECT_NEAR(at(thin, 17.3f, roughness).color.y.v, 0.125f, 1e-6f) << roughness;
  }
}

}  // namespace
}  // namespace zoneplate
