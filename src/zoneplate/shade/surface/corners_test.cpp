// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/corners.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "zoneplate/math/random.h"
#include "zoneplate/shade/surface/surface_for_test.h"

namespace zoneplate {
namespace {

/// A triangle with a different normal at each corner, under a light from the front and one near the eye.
Scene bent_triangle() {
  Scene scene = flat_triangle(ShadingModel::BlinnPhong, {0.5f, 0.25f, 1, 1}, {0.5f, 0.5f, 0.5f});
  scene.meshes[0].normal = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, -0.8f, 0.6f}};
  Light bulb = sun({0, 0, -1});
  bulb.kind = LightKind::Point, bulb.position = {1, 1, 2};
  scene.lights = {sun({0.3f, 0, -1}), bulb};
  return scene;
}

ViewUniforms from(float3 eye, ShadingFrequency frequency) {
  ViewUniforms view;
  view.eye = eye, view.shading_frequency = frequency;
  return view;
}

const Hand& places() {
  static const Hand hand{{0.5f, 0.25f, 0.25f}, {0.1f, 0.7f, 0.2f}, {1, 0, 0}};
  return hand;
}

TEST(ShadingFrequency, AtVerticesColoursAreInterpolated) {
  const Scene scene = bent_triangle();
  const auto corner = [&](float3 weights) {
    return color_of(scene, from({0, 1, 3}, ShadingFrequency::Fragment), weights);
  };
  const float4 a = corner({1, 0, 0}), b = corner({0, 1, 0}), c = corner({0, 0, 1});
  const auto shaded = shade(scene, from({0, 1, 3}, ShadingFrequency::Vertex), places());
  expect_near(shaded->color(0), a * 0.5f + b * 0.25f + c * 0.25f, 1e-6f);
  expect_near(shaded->color(1), a * 0.1f + b * 0.7f + c * 0.2f, 1e-6f);
  EXPECT_EQ(shaded->color(2), a);
}

TEST(ShadingFrequency, FlatTrianglesHaveOneColourByTheirPlane) {
  Scene scene = bent_triangle();
  const auto flat = shade(scene, from({0, 1, 3}, ShadingFrequency::Triangle), places());
  scene.meshes[0].normal.assign(3, {0, 0, 1});
  constexpr float third = 1.0f / 3;
  const float4 middle = color_of(scene, from({0, 1, 3}, ShadingFrequency::Fragment), {third, third, third});
  for (std::size_t i = 0; i < 3; ++i) expect_near(flat->color(i), middle, 1e-6f);
}

TEST(ShadingFrequency, TheBaseColoursTextureKeepsTheDetailOfFragments) {
  Scene scene = bent_triangle();
  const float4 plain = color_of(scene, from({0, 1, 3}, ShadingFrequency::Vertex));
  scene.images = {{"grey", one_texel({255, 188, 0, 255})}};
  scene.materials[0].base_color_texture.image = 0;
  const float4 textured = color_of(scene, from({0, 1, 3}, ShadingFrequency::Vertex));
  EXPECT_EQ(textured.x, plain.x);
  EXPECT_NEAR(textured.y, plain.y * 0.5029f, 1e-4f);
  EXPECT_EQ(textured.z, 0);
}

TEST(ShadingFrequency, TheSolidTextureIsEvaluatedAtFragments) {
  constexpr SolidTexture noise{.pattern = SolidPattern::Noise, .scale = 3.7f, .is_filtered = false};
  Scene scene = bent_triangle();
  const auto plain = shade(scene, from({0, 1, 3}, ShadingFrequency::Vertex), places());
  scene.materials[0].solid_texture = noise;
  const auto textured = shade(scene, from({0, 1, 3}, ShadingFrequency::Vertex), places());
  scene.materials[0].model = ShadingModel::Unlit, scene.materials[0].base_color = {1, 1, 1, 1};
  const auto pattern = shade(scene, from({0, 1, 3}, ShadingFrequency::Fragment), places());
  for (std::size_t i = 0; i < 3; ++i) {
    const float4 expected{plain->color(i).x * pattern->color(i).x, plain->color(i).y * pattern->color(i).y,
                          plain->color(i).z * pattern->color(i).z, 1};
    expect_near(textured->color(i), expected, 1e-6f);
  }
  EXPECT_GT(std::abs(pattern->color(0).x - pattern->color(1).x), 0.01f);
}

TEST(TriangleCorners, FullBatchesHaveTheColoursOfSmallOnes) {
  Scene scene = bent_triangle();
  Mesh& mesh = scene.meshes[0];
  for (std::uint32_t k = 0; k < 300; ++k) {
    mesh.position.push_back({unit_float(hash(k, 1)), unit_float(hash(k, 2)), unit_float(hash(k, 3))});
    mesh.normal.push_back(mesh.normal[k % 3]);
    mesh.uv0.push_back({0, 0});
  }
  const auto fragments = [](std::uint32_t first, std::uint32_t count) {
    Hand hand;
    for (std::uint32_t k = first; k < first + count; ++k) {
      hand.add({0, unit_float(hash(k, 4)) / 2, unit_float(hash(k, 5)) / 2});
      const std::size_t i = k - first;
      hand.batch.triangle[i] = k / 2 * 3;
      for (std::uint32_t c = 0; c < 3; ++c) hand.batch.vertex[c][i] = k / 2 + c;
    }
    hand.pad();
    return hand;
  };
  for (const ShadingFrequency frequency : {ShadingFrequency::Vertex, ShadingFrequency::Triangle}) {
    const auto all = shade(scene, from({0, 1, 3}, frequency), fragments(0, 256));
    for (std::uint32_t k = 0; k < 256; k += 5)
      ASSERT_EQ(all->color(k), shade(scene, from({0, 1, 3}, frequency), fragments(k, 1))->color()) << k;
  }
}

}  // namespace
}  // namespace zoneplate
