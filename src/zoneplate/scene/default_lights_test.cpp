// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/default_lights.h"

#include <gtest/gtest.h>

#include "zoneplate/scene/camera.h"

namespace zoneplate {
namespace {

TEST(DefaultLights, AreAKeyAFillAndABackLightOfUnitDirection) {
  std::vector<Light> lights;
  for (const Light& light : default_lights()) lights.push_back(in_world_space(light, Camera().world_from_camera));
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_EQ(lights[0].name, "key");
  EXPECT_EQ(lights[1].name, "fill");
  EXPECT_EQ(lights[2].name, "back");
  for (const Light& light : lights) {
    EXPECT_EQ(light.kind, LightKind::Directional);
    EXPECT_NEAR(length(light.direction), 1, 1e-6);
  }
  // The camera looks along -Z: key and fill travel away from it, the back light towards it.
  EXPECT_LT(lights[0].direction.z, 0);
  EXPECT_LT(lights[1].direction.z, 0);
  EXPECT_GT(lights[2].direction.z, 0);
  EXPECT_GT(lights[0].intensity, 4 * lights[1].intensity);
}

TEST(DefaultLights, TurnWithTheCamera) {
  // A camera that looks along +X: the camera's -Z is +X in the world.
  Camera camera;
  camera.world_from_camera = {{float4{0, 0, 1, 0}, float4{0, 1, 0, 0}, float4{-1, 0, 0, 0}, float4{5, 6, 7, 1}}};
  const Light straight = in_world_space(default_lights()[0], Camera().world_from_camera);
  const Light turned = in_world_space(default_lights()[0], camera.world_from_camera);
  EXPECT_FLOAT_EQ(turned.direction.x, -straight.direction.z);
  EXPECT_FLOAT_EQ(turned.direction.y, straight.direction.y);
  EXPECT_FLOAT_EQ(turned.direction.z, straight.direction.x);
}

}  // namespace
}  // namespace zoneplate
