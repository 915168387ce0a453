// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/look/default_material.h"

#include <gtest/gtest.h>

#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {
namespace {

Scene plain_scene() {
  Scene scene;
  scene.materials = {plain_material("default"), Material{.name = "own"}};
  scene.meshes.resize(2);
  scene.meshes[1].material = 1;
  return scene;
}

TEST(DefaultMaterial, ChangesSurfacesWithoutAMaterial) {
  Scene scene = plain_scene();
  set_default_material({.color = float4{0.5f, 0.25f, 0, 0.5f}}, {}, scene);
  EXPECT_EQ(scene.materials[0].base_color, (float4{0.5f, 0.25f, 0, 0.5f}));
  EXPECT_EQ(scene.materials[0].ambient, (float3{0.5f, 0.25f, 0}));
  EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::Blend);
  EXPECT_EQ(scene.materials[0].model, ShadingModel::BlinnPhong);
  EXPECT_EQ(scene.materials[1].base_color, (float4{1, 1, 1, 1}));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(DefaultMaterial, IsMetallicRoughnessByItsFactors) {
  Scene scene = plain_scene();
  set_default_material({.metallic = 1.0f}, {}, scene);
  EXPECT_EQ(scene.materials[0].model, ShadingModel::MetallicRoughness);
  EXPECT_EQ(scene.materials[0].metallic, 1);
  EXPECT_EQ(scene.materials[0].base_color, (float4{0.8f, 0.8f, 0.8f, 1}));
  set_default_material({.roughness = 0.25f}, {}, scene);
  EXPECT_EQ(scene.materials[0].roughness, 0.25f);
}

TEST(DefaultMaterial, WarnsWhereItHasNoEffect) {
  Scene scene = plain_scene();
  scene.materials[0].is_default = false;
  set_default_material({.color = float4{1, 0, 0, 1}}, {}, scene);
  EXPECT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.materials[0].base_color, (float4{0.8f, 0.8f, 0.8f, 1}));
}

}  // namespace
}  // namespace zoneplate
