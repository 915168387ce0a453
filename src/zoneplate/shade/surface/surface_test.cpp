// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/surface/surface_for_test.h"

namespace zoneplate {
namespace {

TEST(Surface, UnlitIsTheBaseColour) {
  Scene scene = flat_triangle();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.materials[0].base_color = {0.25f, 0.5f, 2, 0.5f};
  scene.materials[0].emissive = {1, 1, 1};
  scene.lights = {sun({0, 0, -1})};
  EXPECT_EQ(color_of(scene, {}), (float4{0.25f, 0.5f, 2, 1}));
}

TEST(Surface, AlphaModesSayWhatAlphaMeans) {
  Scene scene = flat_triangle();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.materials[0].base_color = {0.5f, 0.25f, 1, 0.5f};
  scene.meshes[0].color.assign(3, float4{1, 1, 1, 0.5f});
  for (const AlphaMode mode : {AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend}) {
    scene.materials[0].alpha_mode = mode;
    const float4 blended{0.125f, 0.0625f, 0.25f, 0.25f}, solid{0.5f, 0.25f, 1, 1};
    EXPECT_EQ(color_of(scene, {}), mode == AlphaMode::Blend ? blended : solid);
    float alpha[FragmentBatch::capacity];
    Surfaces(scene, {}).shader.alpha(Hand{{0.5f, 0.25f, 0.25f}}.batch, alpha);
    EXPECT_EQ(alpha[0], 0.25f);
  }
}

TEST(Surface, VertexColoursAreInterpolated) {
  Scene scene = flat_triangle();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.meshes[0].color = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  EXPECT_EQ(color_of(scene, {}, {0.5f, 0.375f, 0.125f}), (float4{0.5f, 0.375f, 0.125f, 1}));
}

TEST(Surface, AlphaStaysBetweenZeroAndOne) {
  Scene scene = flat_triangle();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.materials[0].alpha_mode = AlphaMode::Blend;
  scene.materials[0].base_color = {0.5f, 0.25f, 1, 3};
  EXPECT_EQ(color_of(scene, {}), (float4{0.5f, 0.25f, 1, 1}));
  float alpha[FragmentBatch::capacity];
  Surfaces(scene, {}).shader.alpha(Hand{{0.5f, 0.25f, 0.25f}}.batch, alpha);
  EXPECT_EQ(alpha[0], 1.0f);
}

TEST(Surface, MeshesWithoutNormalsAreUnlit) {
  Scene scene = flat_triangle();
  scene.materials[0].base_color = {0.5f, 0.25f, 1, 1};
  Mesh bare = scene.meshes[0];
  bare.normal.clear();
  scene.meshes.push_back(bare);
  scene.instances.push_back({1, 0, {}});
  Hand hand;
  hand.add({0.5f, 0.25f, 0.25f}, 0), hand.add({0.5f, 0.25f, 0.25f}, 1);
  hand.pad();
  const auto outcome = shade(scene, {.eye = {0.25f, 0.25f, 2}}, hand);
  EXPECT_EQ(outcome->color(0).x, 0.0f);
  EXPECT_EQ(outcome->color(1), (float4{0.5f, 0.25f, 1, 1}));
  EXPECT_EQ(outcome->normal(1), (float3{0, 0, 1}));
}

/// A scene with every feature and a batch of points at random.
Scene everything() {
  Scene scene = flat_triangle();
  Mesh& mesh = scene.meshes[0];
  mesh.uv1 = {{0.1f, 3}, {-2, 1}, {0.5f, 0.7f}};
  mesh.color = {{1, 0.5f, 1, 0.9f}, {0.3f, 1, 1, 0.2f}, {1, 1, 0.1f, 1}};
  mesh.normal = {normalize({0.1f, 0, 1}), normalize({0.3f, -0.4f, 1}), {0, 0, 1}};
  Mesh bare = mesh;
  bare.normal.clear(), bare.tangent.clear(), bare.uv1.clear();
  scene.meshes.push_back(bare);
  for (int i = 0; i < 6; ++i) {
    const auto k = static_cast<float>(i);
    scene.instances.push_back({i % 3 == 2 ? 1 : 0, 0, rotation(Quaternion{1, k, 2, 3}) * scaling({1, 1 + k, -1})});
  }
  for (std::uint32_t s = 0; s < 3; ++s) {
    Rgba8Image image(16 << s, 13);
    for (Rgba8& texel : image.values()) {
      const std::uint32_t word = hash(static_cast<std::uint32_t>(&texel - &image(0, 0)), s);
      texel = {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
               static_cast<std::uint8_t>(word >> 16), static_cast<std::uint8_t>(word >> 24)};
    }
    scene.images.push_back({"", image});
  }
  Material& m = scene.materials[0];
  m.alpha_mode = AlphaMode::Blend;
  m.base_color_texture.image = 0, m.metallic_roughness_texture.image = 1, m.normal_texture.image = 2;
  m.emissive_texture.image = 0, m.occlusion_texture.image = 1;
  m.emissive = {0.1f, 0.2f, 0.3f}, m.ambient = {1, 0.5f, 0.2f}, m.specular = {0.5f, 1, 0.1f};
  m.normal_texture.uv_set = 1, m.emissive_texture.rotation = 0.3f, m.emissive_texture.scale = {3, 0.2f};
  Light bulb = sun({0, 1, 0}), spot = bulb;
  bulb.kind = LightKind::Point, bulb.position = {1, 1, 1}, bulb.range = 30;
  spot.kind = LightKind::Spot, spot.position = {0, 3, 2}, spot.direction = normalize({0, -3, -2});
  scene.lights = {sun(normalize({-1, -1, -1})), bulb, spot};
  return scene;
}

Hand random_points(int count) {
  Hand hand;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::uint32_t>(i);
    const float a = unit_float(hash(k, 1)), b = unit_float(hash(k, 2)) * (1 - a);
    hand.add({a, b, 1 - a - b}, k < 24 ? k / 8 : hash(k, 3) % 7, hash(k, 4) % 3 != 0);
    for (std::size_t c = 0; c < 2; ++c) {
      const auto at = static_cast<std::size_t>(i);
      hand.batch.dbdx[c][at] = 0.1f * (unit_float(hash(k, 5, static_cast<std::uint32_t>(c))) - 0.5f);
      hand.batch.dbdy[c][at] = 0.1f * (unit_float(hash(k, 6, static_cast<std::uint32_t>(c))) - 0.5f);
    }
  }
  if (count > 0) hand.pad();
  return hand;
}

constexpr ShadingModel all_models[] = {ShadingModel::MetallicRoughness, ShadingModel::BlinnPhong, ShadingModel::Phong,
                                       ShadingModel::Unlit};

TEST(Surface, EveryInstructionSetGivesTheSameBits) {
  Scene scene = everything();
  const ViewUniforms view{.eye = {1, 2, 5}, .environment = {0.3f, 0.4f, 0.5f}, .ambient_light = {0.2f, 0.2f, 0.2f}};
  for (const ShadingModel model : all_models) {
    scene.materials[0].model = model;
    for (const int count : {1, 7, 8, 33, 128}) {
      const auto shaded_with = [&](Isa isa) {
        return with_isa(isa, [&] { return shade(scene, view, random_points(count)); });
      };
      const auto expected = shaded_with(Isa::Scalar);
      for (const Isa isa : supported_isas()) {
        const auto actual = shaded_with(isa);
        ASSERT_EQ(std::memcmp(actual.get(), expected.get(), sizeof(Outcome)), 0) << name_of(isa) << " " << count;
      }
    }
  }
}

TEST(Surface, TheBitsAreTheSameForEveryCompiler) {
  // A changed word here is a changed image: say why in the change.
  Scene scene = everything();
  std::uint32_t word = 0;
  for (const ShadingModel model : all_models) {
    scene.materials[0].model = model;
    const auto outcome = shade(scene, {.eye = {1, 2, 5}, .environment = {0.3f, 0.4f, 0.5f}}, random_points(128));
    const FragmentOutputs& all = outcome->shaded;
    for (const float* values : {all.r, all.g, all.b, all.a, all.normal[0], all.normal[1], all.normal[2], all.uv[0],
                                all.uv[1], all.albedo[0], all.albedo[1], all.albedo[2]})
      for (std::size_t i = 0; i < 128; ++i) {
        std::uint32_t number;
        std::memcpy(&number, &values[i], sizeof number);
        word = hash(word, number);
      }
  }
  EXPECT_EQ(word, 3013516634u);
}

TEST(Surface, APointsColourDoesNotDependOnItsNeighbours) {
  Scene scene = everything();
  const ViewUniforms view{.eye = {1, 2, 5}, .environment = {0.3f, 0.4f, 0.5f}};
  const Hand all = random_points(128);
  for (const ShadingModel model : all_models) {
    scene.materials[0].model = model;
    const auto together = shade(scene, view, all);
    for (std::size_t i = 0; i < 128; i += 9) {
      Hand alone;
      alone.add({0, all.batch.b[0][i], all.batch.b[1][i]}, all.batch.instance[i], all.batch.is_front[i] != 0);
      for (std::size_t c = 0; c < 2; ++c) {
        alone.batch.dbdx[c][0] = all.batch.dbdx[c][i], alone.batch.dbdy[c][0] = all.batch.dbdy[c][i];
      }
      alone.pad();
      // As eight fragments of any triangles, and as eight of one triangle that is declared once.
      for (const bool is_shared : {false, true}) {
        alone.batch.is_flat_run[0] = is_shared, alone.batch.run_end[0] = 1;
        const auto outcome = shade(scene, view, alone);
        ASSERT_EQ(std::memcmp(&together->shaded.r[i], &outcome->shaded.r[0], sizeof(float)), 0) << i;
        ASSERT_EQ(outcome->color(), together->color(i)) << i;
        ASSERT_EQ(outcome->normal(), together->normal(i)) << i;
      }
    }
  }
}

TEST(Surface, AskingForMoreDoesNotChangeTheColour) {
  Scene scene = everything();
  const Hand hand = random_points(100);
  for (const ShadingModel model : all_models) {
    scene.materials[0].model = model;
    const Surfaces surfaces(scene, {.eye = {1, 2, 5}, .environment = {0.3f, 0.4f, 0.5f}});
    const SurfaceShader& shader = surfaces.shader;
    const auto full = shade(scene, {.eye = {1, 2, 5}, .environment = {0.3f, 0.4f, 0.5f}}, hand);
    Outcome plain;
    shader.shade(hand.batch, {}, plain.shaded);
    float alpha[FragmentBatch::capacity];
    shader.alpha(hand.batch, alpha);
    for (std::size_t i = 0; i < 100; ++i) {
      ASSERT_EQ(plain.color(i), full->color(i));
      ASSERT_EQ(plain.color(i).w, alpha[i]);
    }
  }
}

TEST(Surface, AllOutputsAreFinite) {
  Scene scene = everything();
  Mesh& mesh = scene.meshes[0];
  mesh.normal[1] = {0, 0, 0};
  mesh.uv0[2] = {1e38f, -1e38f};
  mesh.position[2] = {1e18f, 0, 0};
  scene.instances[1].world_from_object = scaling({0, 0, 0});
  scene.lights[1].position = {0, 0, 0};
  for (const ShadingModel model : all_models) {
    scene.materials[0].model = model;
    const auto outcome = shade(scene, {.environment = {1, 1, 1}}, random_points(128));
    const auto* numbers = reinterpret_cast<const float*>(&outcome->shaded);
    for (std::size_t i = 0; i < 7 * FragmentBatch::capacity; ++i) ASSERT_TRUE(std::isfinite(numbers[i])) << i;
  }
}

}  // namespace
}  // namespace zoneplate
