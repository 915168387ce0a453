// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/brightness.h"

#include <gtest/gtest.h>

#include <limits>

#include "zoneplate/shade/surface/lighting.h"
#include "zoneplate/shade/surface/material_plan.h"
#include "zoneplate/shade/texture/texture.h"

namespace zoneplate {
namespace {

MaterialPlan plan_of(ShadingModel model) {
  MaterialPlan plan;
  plan.model = model;
  plan.is_lit = model != ShadingModel::Unlit;
  return plan;
}

float bound(const MaterialPlan& plan, std::span<const PreparedLight> lights = {}, float3 environment = {0, 0, 0}) {
  return brightest_fragment(std::span(&plan, 1), lights, environment);
}

TEST(Brightness, OfAnUnlitSurfaceIsThatOfItsBaseColour) {
  MaterialPlan plan = plan_of(ShadingModel::Unlit);
  EXPECT_EQ(bound(plan), 1);
  plan.factor[1] = 40;
  EXPECT_EQ(bound(plan), 40);
  plan.factor[1] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(bound(plan), brightest_color);
}

TEST(Brightness, IsThatOfTheBrightestMaterial) {
  MaterialPlan plans[] = {plan_of(ShadingModel::Unlit), plan_of(ShadingModel::Unlit), plan_of(ShadingModel::Unlit)};
  plans[1].factor[0] = 1e6f;
  EXPECT_EQ(brightest_fragment(plans, {}, {0, 0, 0}), 1e6f);
}

TEST(Brightness, VertexColoursMayBeAnything) {
  MaterialPlan plan = plan_of(ShadingModel::Unlit);
  plan.attributes.color = true;
  EXPECT_EQ(bound(plan), brightest_color);
}

TEST(Brightness, TexturesOfFloatsMayBeAnything) {
  const Texture codes(TexelImage(Rgba8Image(2, 2)), TexelMeaning::Color);
  const Texture light(TexelImage(Plane<float4>(2, 2)), TexelMeaning::Color);
  MaterialPlan plan = plan_of(ShadingModel::MetallicRoughness);
  plan.slot(TextureSlotIndex::BaseColor).texture = plan.slot(TextureSlotIndex::Emissive).texture = &codes;
  EXPECT_LT(bound(plan), 10);
  plan.slot(TextureSlotIndex::Emissive).texture = &light;
  EXPECT_EQ(bound(plan), brightest_color);
  plan.slot(TextureSlotIndex::Emissive).texture = &codes, plan.slot(TextureSlotIndex::BaseColor).texture = &light;
  EXPECT_EQ(bound(plan), brightest_color);
}

TEST(Brightness, CountsEmissionLightsAndSurroundings) {
  MaterialPlan plan = plan_of(ShadingModel::MetallicRoughness);
  const float dark = bound(plan);
  plan.emissive_factor[2] = 1000;
  EXPECT_GE(bound(plan), 1000);
  EXPECT_LT(bound(plan), dark + 2001);
  PreparedLight sun;
  sun.radiance[0] = 7;
  plan = plan_of(ShadingModel::BlinnPhong);
  plan.specular[0] = 3;
  EXPECT_GE(bound(plan, std::span(&sun, 1)), 7 + 21);
  EXPECT_GE(bound(plan_of(ShadingModel::MetallicRoughness), {}, {0, 5, 0}), 5);
  // A lamp may be next to the surface.
  sun.is_directional = false;
  EXPECT_GE(bound(plan, std::span(&sun, 1)), 7e6f);
}

// A highlight at its centre, of the smoothest surface.
TEST(Brightness, IsAboveAMirrorsHighlight) {
  MaterialPlan plan = plan_of(ShadingModel::MetallicRoughness);
  plan.roughness = 0.5f;
  PreparedLight sun;
  sun.radiance[0] = 1;
  const float alpha = 0.25f, peak = 1 / (3.14159265f * alpha * alpha) / 4;
  EXPECT_GE(bound(plan, std::span(&sun, 1)), peak);
}

}  // namespace
}  // namespace zoneplate
