// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/height_normals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace zoneplate {
namespace {

TEST(HeightNormals, AreThoseOfAPlane) {
  Plane<float> ramp(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) ramp(x, y) = 0.25f * static_cast<float>(x) - 0.5f * static_cast<float>(y);
  for (const GradientStencil stencil : {GradientStencil::Central, GradientStencil::Sobel}) {
    const float3 n = normals_of(ramp, {.stencil = stencil, .strength = 2})(3, 4);
    const float length = std::sqrt(0.25f + 1 + 1);
    EXPECT_NEAR(n.x, -0.5f / length, 1e-6);  // it rises to the right
    EXPECT_NEAR(n.y, -1 / length, 1e-6);     // and up the image
    EXPECT_NEAR(n.z, 1 / length, 1e-6);
  }
}

TEST(HeightNormals, WrapAtTheBorder) {
  Plane<float> step(4, 1, 0.0f);
  step(3, 0) = 1;
  const auto x_of = [&](Wrap wrap, int x) {
    return normals_of(step, {.stencil = GradientStencil::Central, .wrap_u = wrap, .wrap_v = wrap})(x, 0).x;
  };
  EXPECT_GT(x_of(Wrap::Repeat, 0), 0.4f);  // the step lies to the left of the first texel
  EXPECT_EQ(x_of(Wrap::Clamp, 0), 0.0f);
  EXPECT_LT(x_of(Wrap::Clamp, 3), -0.4f);
  EXPECT_EQ(x_of(Wrap::Mirror, 0), 0.0f);
}

}  // namespace
}  // namespace zoneplate
