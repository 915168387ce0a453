// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/scene.h"

#include <gtest/gtest.h>

#include "zoneplate/math/transform.h"

namespace zoneplate {
namespace {

TEST(Scene, BoundsHoldTheVerticesThatAreDrawn) {
  Scene s;
  EXPECT_TRUE(s.bounds().empty());
  s.meshes.resize(1);
  s.meshes[0].position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {99, 99, 99}};
  s.meshes[0].index = {0, 1, 2};
  EXPECT_TRUE(s.bounds().empty());
  s.instances = {{0, 0, translation({10, 0, 0})}, {0, 0, scaling({-2, 1, 1})}};
  EXPECT_EQ(s.bounds().low, (float3{-2, 0, 0}));
  EXPECT_EQ(s.bounds().high, (float3{11, 1, 0}));
}

}  // namespace
}  // namespace zoneplate
