// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/environment_background.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "zoneplate/image/plane.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/scene/facing_for_test.h"
#include "zoneplate/scene/material_layers.h"
#include "zoneplate/shade/environment/prepared_environment.h"

namespace zoneplate {
namespace {

constexpr int side = 32;
constexpr float wall = 0.5f;

/// A wall of one radiance, which is all that the camera sees, below a much brighter sky.
Environment bright_sky() {
  Plane<float4> image(64, 32);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const float light = y < 10 ? 100 : wall;
      image(x, y) = {light, light, light, 1};
    }
  Environment environment;
  environment.color = {1, 1, 1};
  environment.map = std::make_shared<const PreparedEnvironment>(prepare_equirectangular(std::move(image)));
  return environment;
}

/// A pane that covers the view and does not reflect.
Scene pane(float roughness, float thickness) {
  Mesh mesh;
  mesh.position = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  mesh.index = {0, 1, 2, 0, 2, 3};
  auto layers = std::make_shared<MaterialLayers>();
  layers->transmission = 1, layers->specular = 0, layers->thickness = thickness;
  Material material;
  material.base_color = {1, 1, 1, 1};
  material.metallic = 0, material.roughness = roughness, material.layers = std::move(layers);
  Scene scene = facing_scene(std::move(mesh), std::move(material));
  scene.materials[0].model = ShadingModel::MetallicRoughness;
  return scene;
}

TEST(EnvironmentBackground, IsSeenThroughGlassAsTheSceneIs) {
  Camera camera;
  camera.world_from_camera.column[3] = {0, 0, 4, 1};
  Environment environment = bright_sky();
  for (const float roughness : {0.0f, 0.3f, 0.6f, 1.0f})
    for (const float thickness : {0.0f, 1.0f}) {
      Scene scene = pane(roughness, thickness);
      scene.environment = environment;
      const RenderOptions options{.width = side, .height = side, .background = EnvironmentBackground{}};
      const Frame frame = render(PreparedScene(std::move(scene)), camera, {.samples = {SamplePosition{}}}, options);
      for (const Linear& c : frame.color.values()) {
        ASSERT_NEAR(c.r, wall, 1e-3f * wall) << roughness << " " << thickness;
        ASSERT_EQ(c.a, 1);
      }
    }
}

}  // namespace
}  // namespace zoneplate
