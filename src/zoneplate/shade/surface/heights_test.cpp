// SPDX-License-Identifier: Apache-2.0
// Height textures: bump mapping and parallax; roughness that accounts for the variance of normals.
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/shade/surface/surface_for_test.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

/// Heights that rise by `step` codes a texel to the right.
Rgba8Image ramp(int size, int step) {
  Rgba8Image image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) image(x, y) = {static_cast<std::uint8_t>(step * x), 0, 0, 255};
  return image;
}

Scene bumpy(const Rgba8Image& heights, float scale) {
  Scene scene = flat_triangle();
  scene.images = {{"heights", heights}};
  scene.materials[0].height_texture.image = 0;
  scene.materials[0].height_scale = scale;
  scene.lights = {sun({0, 0, -1})};
  return scene;
}

TEST(Heights, TiltTheNormalByTheirGradientInTheWorld) {
  // 64 texels over one unit, 2 codes a texel: a slope of 128/255 × scale.
  Scene scene = bumpy(ramp(64, 2), 0.5f);
  const float slope = 0.5f * 128 / 255;
  const Hand hand{{0.4f, 0.3f, 0.3f}};
  EXPECT_LT(length(shade(scene, {}, hand)->normal() - normalize({-slope, 0, 1})), 1e-4f);

  // Twice as wide, half as steep; twice as many repeats, twice as steep.
  scene.instances[0].world_from_object = scaling({2, 2, 2});
  EXPECT_LT(length(shade(scene, {}, hand)->normal() - normalize({-slope / 2, 0, 1})), 1e-4f);
  scene.materials[0].height_texture.scale = {2, 2};
  const Hand left{{0.6f, 0.2f, 0.2f}};
  EXPECT_LT(length(shade(scene, {}, left)->normal() - normalize({-slope, 0, 1})), 1e-4f);

  // Turned, u runs against y.
  scene.materials[0].height_texture.rotation = 1.57079633f;
  EXPECT_LT(length(shade(scene, {}, left)->normal() - normalize({0, slope, 1})), 1e-4f);
}

TEST(Heights, TurnWithTheFaceAndTheMirror) {
  Scene scene = bumpy(ramp(64, 2), 0.5f);
  const float slope = 0.5f * 128 / 255;
  Hand hand;
  hand.add({0.4f, 0.3f, 0.3f}, 0, false);
  hand.pad();
  EXPECT_LT(length(shade(scene, {}, hand)->normal() - normalize({slope, 0, -1})), 1e-4f);
  scene.instances[0].world_from_object = scaling({-1, 1, 1});
  EXPECT_LT(length(shade(scene, {}, Hand{{0.4f, 0.3f, 0.3f}})->normal() - normalize({slope, 0, 1})), 1e-4f);
}

TEST(Heights, MoveTheCoordinatesToTheParallax) {
  // A constant height of h lies (1 - h) × scale below the surface.
  Scene scene = bumpy(one_texel({51, 0, 0, 255}), 0.1f);
  scene.materials[0].parallax_layers = 8;
  scene.images.push_back({"colour", ramp(16, 16)});
  scene.materials[0].base_color_texture.image = 1;
  const float3 back = normalize({1, 0, 2});
  ViewUniforms view;
  view.is_orthographic = true, view.view_direction = -back;
  const Hand hand{{0.4f, 0.3f, 0.3f}};
  const auto outcome = shade(scene, view, hand);
  EXPECT_NEAR(outcome->shaded.uv[0][0], 0.3f - 0.8f * 0.1f / 2, 1e-6);
  EXPECT_NEAR(outcome->shaded.uv[1][0], 0.7f, 1e-6);
  scene.materials[0].parallax_layers = 0;
  EXPECT_NEAR(shade(scene, view, hand)->shaded.uv[0][0], 0.3f, 1e-6);
}

TEST(Heights, MeetTheRayOnARamp) {
  // Heights 1 - u below: the ray from (u0, 0) into the surface meets depth u scale where u = u0 - t / 2, depth = t.
  Rgba8Image heights(256, 1);
  for (int x = 0; x < 256; ++x) heights(x, 0) = {static_cast<std::uint8_t>(255 - x), 0, 0, 255};
  Scene scene = bumpy(heights, 0.5f);
  scene.materials[0].parallax_layers = 16;
  scene.materials[0].base_color_texture.image = 0;
  ViewUniforms view;
  view.is_orthographic = true, view.view_direction = -normalize({1, 0, 2});
  const float u = shade(scene, view, Hand{{0.3f, 0.4f, 0.3f}})->shaded.uv[0][0];
  EXPECT_NEAR(u, 0.4f / 1.25f, 3e-3);  // t = u / 2 = (u0 - u) × 2
}

Scene mirror(float roughness) {
  Scene scene = flat_triangle();
  scene.materials[0].metallic = 1, scene.materials[0].roughness = roughness;
  scene.lights = {sun({0, 0, -1})};
  return scene;
}

ViewUniforms from_above(SpecularAntialiasing kind) {
  ViewUniforms view;
  view.is_orthographic = true, view.view_direction = {0, 0, -1};
  view.specular_aa = kind;
  return view;
}

/// The colour at the peak of the highlight.
float peak(const Scene& scene, SpecularAntialiasing kind, const Hand& hand) {
  return shade(scene, from_above(kind), hand)->color().x;
}

/// The same for a surface of this α², which is the fourth power of its roughness.
float peak_of(float alpha2) {
  return peak(mirror(std::sqrt(std::sqrt(alpha2))), SpecularAntialiasing::None, Hand{{1, 0, 0}});
}

TEST(SpecularAntialiasing, WidensByTheVarianceOfANormalMap) {
  // Slopes of ±1/4 along x, texel by texel: a variance of 1/16 at all levels but the first.
  const float x = 0.25f / std::sqrt(1 + 0.0625f), z = 1 / std::sqrt(1 + 0.0625f);
  Plane<float4> map(16, 16);
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) map(i, j) = {0.5f + (i % 2 == 0 ? x : -x) / 2, 0.5f, 0.5f + z / 2, 1};
  Scene scene = mirror(0.5f);
  scene.meshes[0].tangent.assign(3, float4{1, 0, 0, 1});
  scene.images = {{"map", map}};
  scene.materials[0].normal_texture.image = 0;
  Hand hand{{0.4f, 0.3f, 0.3f}};
  constexpr float alpha2 = 0.0625f, two_texels = 2.0f / 16;
  for (std::size_t i = 0; i < 8; ++i) hand.batch.dbdx[0][i] = two_texels;  // level 1
  using Kind = SpecularAntialiasing;
  EXPECT_NEAR(peak(scene, Kind::None, hand), peak_of(alpha2), 1e-3);
  // Along x the square of α grows by twice the variance: the peak of the density is that of the geometric mean of both
  // axes, and its gain that of their arithmetic mean.
  const float mean = alpha2 + 0.0625f, widened = peak_of(mean) * mean / std::sqrt(alpha2 * (alpha2 + 2 * 0.0625f));
  EXPECT_NEAR(peak(scene, Kind::Lean, hand), widened, 1e-3f);
  EXPECT_NEAR(peak(scene, Kind::Toksvig, hand), peak_of(alpha2 + 2 * (1 - z) / z), 1e-3);
  EXPECT_NEAR(peak(scene, Kind::Geometric, hand), peak_of(alpha2), 1e-3);
  EXPECT_NEAR(peak(scene, Kind::Full, hand), widened, 1e-3f);
  // The same map turned by a right angle, about a tangent that is turned back, gives the same lobe.
  Plane<float4> turned(16, 16);
  for (int j = 0; j < 16; ++j)
    for (int i = 0; i < 16; ++i) turned(i, j) = {0.5f, 0.5f + (i % 2 == 0 ? x : -x) / 2, 0.5f + z / 2, 1};
  scene.images[0].pixels = turned;
  scene.meshes[0].tangent.assign(3, float4{0, -1, 0, 1});
  const float3 aside = normalize(float3{0.3f, 0, -1});
  scene.lights = {sun(aside)};  // the ratio is that of the formula of TurningLobe along x and along y
  const float along = peak(scene, Kind::Lean, hand);
  scene.lights = {sun({aside.y, aside.x, aside.z})};
  EXPECT_NEAR(along, 1.3951f * peak(scene, Kind::Lean, hand), 1e-3f);
}

TEST(SpecularAntialiasing, WidensByTheChangeOfTheNormal) {
  Scene scene = mirror(0.3f);
  // At the first corner the normal points up and turns towards x by 0.4 from corner to corner.
  scene.meshes[0].normal = {{0, 0, 1}, normalize({0.4f, 0, 1}), {0, 0, 1}};
  const float3 n = scene.meshes[0].normal[1];
  Hand hand{{1, 0, 0}};
  for (std::size_t i = 0; i < 8; ++i) hand.batch.dbdx[0][i] = 0.5f;
  const float change = 0.5f * n.x;  // the derivative across the unit normal of the first corner
  // Along x the square of α grows by twice the variance, along y it stays: the peak is that of their geometric mean.
  const float widened = peak_of(0.09f * std::sqrt(0.0081f + change * change / 6));
  EXPECT_NEAR(peak(scene, SpecularAntialiasing::Geometric, hand), widened, 2e-3f * widened);
  EXPECT_NEAR(peak(scene, SpecularAntialiasing::Lean, hand), peak_of(0.0081f), 1e-4f * widened);
}

}  // namespace
}  // namespace zoneplate
