// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/vec.h"

#include <gtest/gtest.h>

#include <limits>

#include "zoneplate/math/box.h"

namespace zoneplate {
namespace {

TEST(Vec, CrossIsRightHanded) {
  const float3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
  EXPECT_EQ(cross(x, y), z);
  EXPECT_EQ(cross(y, z), x);
  EXPECT_EQ(cross(z, x), y);
  const float3 a = {2, -3, 5}, b = {7, 11, -13};
  EXPECT_EQ(dot(cross(a, b), a), 0);
  EXPECT_EQ(dot(cross(a, b), b), 0);
  EXPECT_EQ(cross(a, b), -cross(b, a));
}

TEST(Vec, NormalizeGivesADirectionOrTheOther) {
  EXPECT_EQ(normalize({0, 3, -4}), (float3{0, 0.6f, -0.8f}));
  EXPECT_EQ(normalize({0, 0, 0}, {0, 1, 0}), (float3{0, 1, 0}));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(normalize({nan, 0, 0}, {0, 1, 0}), (float3{0, 1, 0}));
}

TEST(Vec, NormalizeNeitherUnderflowsNorOverflows) {
  for (const float scale : {1e-45f, 1e-40f, 3e-23f, 1e-15f, 1e15f, 1e20f, 1e38f}) {
    EXPECT_EQ(normalize({scale, 0, 0}), (float3{1, 0, 0})) << scale;
    if (scale > 1e-38f) {
      const float3 n = normalize({2 * scale, -3 * scale, scale}), expected = normalize({2, -3, 1});
      for (const float error : {n.x - expected.x, n.y - expected.y, n.z - expected.z})
        EXPECT_NEAR(error, 0, 1e-6f) << scale;
    }
  }
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(normalize({infinity, 0, 0}, {0, 1, 0}), (float3{0, 1, 0}));
}

TEST(Vec, FiniteMeansEveryComponent) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(is_finite({1, 2, 3}));
  EXPECT_FALSE(is_finite({1, infinity, 3}));
  EXPECT_FALSE(is_finite({1, 2, std::numeric_limits<float>::quiet_NaN()}));
}

TEST(Box, HoldsWhatIsAdded) {
  Box box;
  EXPECT_TRUE(box.empty());
  box.add(Box());
  EXPECT_TRUE(box.empty());
  box.add(float3{1, -2, 3});
  EXPECT_FALSE(box.empty());
  EXPECT_EQ(box.size(), (float3{0, 0, 0}));
  box.add(float3{-1, 4, 3});
  EXPECT_EQ(box.centre(), (float3{0, 1, 3}));
  EXPECT_EQ(box.size(), (float3{2, 6, 0}));
  Box corners;
  for (int i = 0; i < 8; ++i) corners.add(box.corner(i));
  EXPECT_EQ(corners.low, box.low);
  EXPECT_EQ(corners.high, box.high);
  EXPECT_EQ(box.corner(5), (float3{box.high.x, box.low.y, box.high.z}));
}

}  // namespace
}  // namespace zoneplate
