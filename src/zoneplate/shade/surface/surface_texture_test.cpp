// SPDX-License-Identifier: Apache-2.0
// Normals, normal maps, and how a material's textures are looked up.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "zoneplate/base/error.h"
#include "zoneplate/scene/material_layers.h"
#include "zoneplate/shade/surface/layered_plan.h"
#include "zoneplate/shade/surface/material_plan.h"
#include "zoneplate/shade/surface/surface_for_test.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

TEST(Surface, BackFacesTurnTheirNormals) {
  Scene scene = flat_triangle();
  scene.materials[0].model = ShadingModel::BlinnPhong;
  scene.lights = {sun({0, 0, 1})};
  Hand hand;
  hand.add({0.5f, 0.25f, 0.25f}, 0, true), hand.add({0.5f, 0.25f, 0.25f}, 0, false);
  hand.pad();
  const auto outcome = shade(scene, {}, hand);
  EXPECT_EQ(outcome->color(0).x, 0.0f);
  EXPECT_EQ(outcome->color(1).x, 1.0f);
  EXPECT_EQ(outcome->normal(0), (float3{0, 0, 1}));
  EXPECT_EQ(outcome->normal(1), (float3{-0.0f, -0.0f, -1}));
}

TEST(Surface, PlacementsTurnScaleAndMirrorNormals) {
  Scene scene = flat_triangle();
  scene.meshes[0].normal.assign(3, normalize({1, 0, 1}));
  scene.instances.clear();
  scene.instances.push_back({0, 0, {}});
  scene.instances.push_back({0, 0, scaling({2, 1, 1})});
  scene.instances.push_back({0, 0, scaling({-1, 1, 1})});
  scene.instances.push_back({0, 0, scaling({1e-7f, 1e-7f, 1e-7f})});
  const float3 expected[] = {normalize({1, 0, 1}), normalize({0.5f, 0, 1}), normalize({-1, 0, 1}),
                             normalize({1, 0, 1})};
  Hand hand;
  for (std::uint32_t i = 0; i < 4; ++i) hand.add({0.5f, 0.25f, 0.25f}, i);
  hand.pad();
  const auto outcome = shade(scene, {}, hand);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_LT(length(outcome->normal(i) - expected[i]), 1e-6f) << i;
}

TEST(Surface, NormalMapsBendNormalsInTheImagesDirections) {
  Scene scene = flat_triangle();
  scene.images = {{"", one_texel({255, 128, 128, 255})}, {"", one_texel({128, 255, 128, 255})}};
  scene.lights = {sun({0, 0, -1})};
  const Hand hand{{0.5f, 0.25f, 0.25f}};
  for (const bool has_tangents : {false, true}) {
    if (has_tangents) scene.meshes[0].tangent.assign(3, float4{1, 0, 0, 1});
    // Red leans along +u, right here; green leans up in the image.
    scene.materials[0].normal_texture.image = 0;
    const float3 right = normalize({1, 1 / 255.0f, 1 / 255.0f}), above = normalize({1 / 255.0f, 1, 1 / 255.0f});
    EXPECT_LT(length(shade(scene, {}, hand)->normal() - right), 1e-6f);
    scene.materials[0].normal_texture.image = 1;
    EXPECT_LT(length(shade(scene, {}, hand)->normal() - above), 1e-6f);
  }
  // Mirrored in x, right is left and above stays above.
  scene.instances[0].world_from_object = scaling({-1, 1, 1});
  EXPECT_GT(shade(scene, {}, hand)->normal().y, 0.99f);
  scene.materials[0].normal_texture.image = 0;
  EXPECT_LT(shade(scene, {}, hand)->normal().x, -0.99f);
}

TEST(Surface, TexturesAreDecodedUnlessRaw) {
  Scene scene = flat_triangle();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.materials[0].base_color = {0.5f, 1, 1, 1};
  scene.images = {{"", one_texel({255, 128, 0, 255})}};
  scene.materials[0].base_color_texture.image = 0;
  EXPECT_EQ(color_of(scene, {.raw_colors = true}), (float4{0.5f, 128 * (1 / 255.0f), 0, 1}));
  EXPECT_NEAR(color_of(scene, {}).y, std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 1e-5);
  EXPECT_EQ(color_of(scene, {}).x, 0.5f);
}

TEST(Surface, TextureTransformsScaleThenRotateThenMove) {
  Scene scene = flat_triangle();
  scene.images = {{"", one_texel({255, 255, 255, 255})}};
  TextureUse& use = scene.materials[0].base_color_texture;
  use.image = 0;
  // The extension's example: the lower left quadrant, turned clockwise.
  use.offset = {0, 1}, use.scale = {0.5f, 0.5f}, use.rotation = 1.5707963f;
  const Hand hand{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto outcome = shade(scene, {}, hand);
  const float2 expected[] = {{0.5f, 1}, {0.5f, 0.5f}, {0, 1}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(outcome->shaded.uv[0][i], expected[i].x, 1e-6);
    EXPECT_NEAR(outcome->shaded.uv[1][i], expected[i].y, 1e-6);
  }
}

TEST(Surface, TheSecondCoordinatesServeTheSlotsThatNameThem) {
  Scene scene = flat_triangle();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.meshes[0].uv1.assign(3, float2{0.75f, 0.5f});
  Rgba8Image halves(2, 1);
  halves(0, 0) = {255, 0, 0, 255}, halves(1, 0) = {0, 255, 0, 255};
  scene.images = {{"", halves}};
  scene.materials[0].base_color_texture = {.image = 0, .sampler = {.wrap_u = Wrap::Clamp}, .uv_set = 0};
  EXPECT_EQ(color_of(scene, {}, {1, 0, 0}), (float4{1, 0, 0, 1}));
  scene.materials[0].base_color_texture.uv_set = 1;
  EXPECT_EQ(color_of(scene, {}, {1, 0, 0}), (float4{0, 1, 0, 1}));
}

TEST(Surface, EachSlotLooksUpItsOwnTexels) {
  Scene scene = flat_triangle();
  Material& m = scene.materials[0];
  m.model = ShadingModel::BlinnPhong;
  m.ambient = m.emissive = {1, 1, 1};
  Rgba8Image halves(2, 1), wide(4, 1, {0, 0, 255, 255});
  halves(0, 0) = {255, 0, 0, 255}, halves(1, 0) = {0, 255, 0, 255};
  wide(1, 0) = {0, 255, 255, 255};
  scene.images = {{"", halves}, {"", wide}};
  const Sampler nearest{.magnify = TexelFilter::Nearest};
  const ViewUniforms surroundings{.ambient_light = {1, 1, 1}};
  m.base_color_texture = {.image = 0, .sampler = nearest};
  const float3 at{0.75f, 0.25f, 0};  // u = 0.25

  m.emissive_texture = m.base_color_texture;
  EXPECT_EQ(color_of(scene, surroundings, at), (float4{2, 0, 0, 1}));
  m.emissive_texture.offset = {0.5f, 0};
  EXPECT_EQ(color_of(scene, surroundings, at), (float4{1, 1, 0, 1}));
  m.emissive_texture = {.image = 1, .sampler = nearest};
  EXPECT_EQ(color_of(scene, surroundings, at), (float4{1, 1, 1, 1}));
  m.emissive_texture = {.image = 0, .sampler = {}};
  EXPECT_EQ(color_of(scene, surroundings, at), (float4{2, 0, 0, 1}));
}

/// Materials that use images 0 and 2 as colours, 0 as data too; nothing uses image 1.
Scene textured_scene() {
  Scene scene = flat_triangle();
  scene.images = {{"both", one_texel({1, 2, 3, 4})}, {"unused", one_texel({})}, {"color", one_texel({5, 6, 7, 8})}};
  Material& m = scene.materials[0];
  m.base_color_texture.image = 0, m.normal_texture.image = 0, m.emissive_texture.image = 2, m.emissive = {1, 1, 1};
  scene.materials.push_back(m);
  scene.materials[1].emissive = {0, 0, 0}, scene.materials[1].emissive_texture.image = 1;
  return scene;
}

TEST(TextureSet, AnImageIsThereOnceForEachMeaning) {
  const Scene scene = textured_scene();
  const TextureSet set(scene, {}), raw(scene, {.raw_colors = true});
  const auto find = [](const TextureSet& in, int image, TexelMeaning meaning) {
    return in.find({.image = image}, meaning);
  };
  EXPECT_NE(find(set, 0, TexelMeaning::Color), find(set, 0, TexelMeaning::Values));
  EXPECT_EQ(find(raw, 0, TexelMeaning::Color), find(raw, 0, TexelMeaning::Values));
  EXPECT_EQ(find(set, 1, TexelMeaning::Values), nullptr);
  EXPECT_NE(find(set, 2, TexelMeaning::Color), nullptr);
  EXPECT_EQ(find(set, -1, TexelMeaning::Color), nullptr);
}

// The second texel of level 0 is transparent and green; where alpha counts, it takes the colour of the first.
TEST(TextureSet, BaseColoursAreWeightedByAlphaWhereItCounts) {
  Rgba8Image pixels(2, 1, Rgba8{255, 0, 0, 255});
  pixels(1, 0) = {0, 255, 0, 0};
  const auto green = [&](std::initializer_list<AlphaMode> modes, const MipOptions& mips, float cutoff = 0.5f) {
    Scene scene = flat_triangle();
    scene.images = {{"leaf", pixels}};
    for (const AlphaMode mode : modes) {
      Material m = scene.materials[0];
      m.alpha_mode = mode, m.alpha_cutoff = cutoff, m.base_color_texture.image = 0;
      scene.materials.push_back(m);
    }
    const TextureSet set(scene, mips);
    const TextureView& view = set.find({.image = 0}, TexelMeaning::Color)->view();
    return view.unorm15[4 * view.texel(0, 1, 0) + 1];
  };
  EXPECT_EQ(green({AlphaMode::Mask}, {}), 0);
  EXPECT_EQ(green({AlphaMode::Mask}, {}, 0), 32767);
  EXPECT_EQ(green({AlphaMode::Blend, AlphaMode::Mask}, {}), 0);
  EXPECT_EQ(green({AlphaMode::Blend}, {.weights_by_alpha = false}), 32767);
  EXPECT_EQ(green({AlphaMode::Opaque}, {}), 32767);
  EXPECT_EQ(green({AlphaMode::Blend, AlphaMode::Opaque}, {}), 32767);
  EXPECT_EQ(green({AlphaMode::Opaque, AlphaMode::Blend}, {}), 32767);
}

TEST(TextureSet, HasTheTexturesOfBlackFactorsForLaterFrames) {
  Scene scene = flat_triangle();
  scene.images = {{"glow", one_texel({0, 255, 0, 255})}, {"coat", one_texel({128, 0, 0, 255})}};
  Material& m = scene.materials[0];
  m.emissive_texture.image = 0;
  auto layers = std::make_shared<MaterialLayers>();
  layers->clearcoat_texture.image = 1;
  m.layers = layers;
  const TextureSet first = TextureSet(scene, {});
  EXPECT_EQ(make_plans(scene, {}, first)[0].slot(TextureSlotIndex::Emissive).texture, nullptr);
  layers->clearcoat = 1, m.emissive = {1, 1, 1};
  const MaterialPlan plan = make_plans(scene, {}, first)[0];
  EXPECT_NE(plan.slot(TextureSlotIndex::Emissive).texture, nullptr);
  EXPECT_NE(plan.layers->slot(LayerSlotIndex::Clearcoat).texture, nullptr);
}

TEST(TextureSet, TakesTheImagesWithIt) {
  Scene scene = textured_scene();
  const TextureSet kept(scene, {}), taken = TextureSet::take(scene, {});
  for (const TextureImage& image : scene.images) EXPECT_TRUE(image.pixels.empty());
  const std::pair<int, TexelMeaning> all[] = {
      {0, TexelMeaning::Color}, {0, TexelMeaning::Values}, {2, TexelMeaning::Color}};
  for (const auto& [image, meaning] : all) {
    const TextureView &view = taken.find({.image = image}, meaning)->view(),
                      &expected = kept.find({.image = image}, meaning)->view();
    const std::int32_t at = 4 * view.texel(0, 0, 0);
    if (meaning == TexelMeaning::Color)
      EXPECT_EQ(std::memcmp(view.unorm15 + at, expected.unorm15 + at, 8), 0);
    else
      EXPECT_EQ(std::memcmp(view.unorm8 + at, expected.unorm8 + at, 4), 0);
  }
  try {
    const TextureSet again(scene, {});
    ADD_FAILURE() << "textures of images that are not there";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "texture both: has no texels");
  }
}

}  // namespace
}  // namespace zoneplate
