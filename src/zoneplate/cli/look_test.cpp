#include "zoneplate/cli/look.h"

#include <gtest/gtest.h>

#include "zoneplate/scene/default_lights.h"

namespace zoneplate::cli {
namespace {

constexpr float3 dim{default_environment, default_environment, default_environment};

TEST(ApplyLook, LightsASceneThatHasNoLight) {
  Scene scene;
  EXPECT_EQ(apply_look(scene, {}, {}), dim);
  EXPECT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.ambient_light, dim);
}

TEST(ApplyLook, LeavesAFilesOwnLightAlone) {
  Scene scene;
  scene.lights.resize(1);
  scene.ambient_light = {0.1f, 0.2f, 0.3f};
  EXPECT_EQ(apply_look(scene, {}, {}), (float3{0, 0, 0}));
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.ambient_light, (float3{0.1f, 0.2f, 0.3f}));
}

TEST(ApplyLook, AnEnvironmentTakesThePlaceOfTheDefaultLights) {
  Scene scene;
  EXPECT_EQ(apply_look(scene, {}, {.environment = float3{1, 0.5f, 0}}), (float3{1, 0.5f, 0}));
  EXPECT_TRUE(scene.lights.empty());
}

TEST(ApplyLook, MultipliesEveryLight) {
  Scene scene;
  scene.lights.resize(2);
  scene.lights[1].intensity = 3;
  apply_look(scene, {}, {.light_intensity = 2});
  EXPECT_EQ(scene.lights[0].intensity, 2);
  EXPECT_EQ(scene.lights[1].intensity, 6);
}

TEST(ChangeModel, KeepsTheWidthOfTheHighlightThereAndBack) {
  Material material;
  material.metallic = 0, material.roughness = 0.5f;
  change_model(material, ShadingModel::BlinnPhong);
  EXPECT_EQ(material.model, ShadingModel::BlinnPhong);
  EXPECT_FLOAT_EQ(material.exponent, 30);  // 2 / 0.5⁴ - 2
  EXPECT_EQ(material.specular, (float3{0.04f, 0.04f, 0.04f}));
  change_model(material, ShadingModel::MetallicRoughness);
  EXPECT_FLOAT_EQ(material.roughness, 0.5f);
  EXPECT_EQ(material.metallic, 0);
}

TEST(ChangeModel, ChangesNothingButTheModelBetweenKin) {
  Material material;
  material.model = ShadingModel::BlinnPhong, material.exponent = 77, material.specular = {1, 2, 3};
  change_model(material, ShadingModel::Phong);
  EXPECT_EQ(material.exponent, 77);
  EXPECT_EQ(material.specular, (float3{1, 2, 3}));
  change_model(material, ShadingModel::Unlit);
  EXPECT_EQ(material.model, ShadingModel::Unlit);
}

}  // namespace
}  // namespace zoneplate::cli
