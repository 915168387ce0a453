// SPDX-License-Identifier: Apache-2.0
// Reflection models under lights, each against its formula.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "zoneplate/math/lanes.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/environment.h"
#include "zoneplate/scene/material_layers.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/reflection/brdf.h"
#include "zoneplate/shade/surface/surface_for_test.h"

namespace zoneplate {
namespace {

/// base (ambient + max(n·l, 0)) + specular max(n·h, 0)^shininess, in double.
double benchmark(double base, double ambient, double nl, double specular, double nh, double shininess) {
  return base * (ambient + std::max(nl, 0.0)) + specular * std::pow(std::max(nh, 0.0), shininess);
}

TEST(Surface, BlinnPhongIsTheTextbooksFormula) {
  Scene scene = flat_triangle(ShadingModel::BlinnPhong, {0.8f, 0.55f, 0.3f, 1});
  Material& m = scene.materials[0];
  m.ambient = {0.8f, 0.55f, 0.3f};
  m.specular = {0.35f, 0.2f, 0.1f};
  m.exponent = 40;
  const float3 to_light = normalize({1, 2, 1});
  scene.lights = {sun(-to_light)};
  for (const float3 eye : {float3{0.25f, 0.25f, 4}, float3{1, 2, 1}, float3{-1, 0.5f, 0.3f}}) {
    const float4 color = color_of(scene, {.eye = eye, .ambient_light = {0.15f, 0.15f, 0.15f}});
    const float3 to_viewer = normalize(eye - float3{0.25f, 0.25f, 0});
    const float3 half = normalize(to_light + to_viewer);
    const auto expected = [&](double base, double specular) {
      return benchmark(base, 0.15f, to_light.z, specular, half.z, 40);
    };
    EXPECT_NEAR(color.x, expected(0.8f, 0.35f), 2e-6);
    EXPECT_NEAR(color.y, expected(0.55f, 0.2f), 2e-6);
    EXPECT_NEAR(color.z, expected(0.3f, 0.1f), 2e-6);
    EXPECT_EQ(color.w, 1);
  }
}

/// Light of radiance 2 from the upper half of space, +Y; none from the lower one.
PreparedEnvironment sky() {
  Plane<float4> image(64, 32, float4{0, 0, 0, 1});
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 64; ++x) image(x, y) = {2, 2, 2, 1};
  return prepare_equirectangular(TexelImage(image));
}

TEST(Surface, BlinnPhongReflectsAnEnvironmentMapByItsNormal) {
  const PreparedEnvironment map = sky();
  const EnvironmentView view = map.view({.color = {1, 1, 1}}, {0, 1, 0});
  const auto color = [&](ShadingModel model, float3 normal, float3 specular, float exponent) {
    Scene scene = flat_triangle(model, {0.5f, 0.25f, 1, 1}, specular);
    scene.meshes[0].normal.assign(3, normal);
    scene.materials[0].exponent = exponent;
    const float3 eye = float3{0.25f, 0.25f, 0} + normal * 5;
    return color_of(scene, {.eye = eye, .environment = {2, 2, 2}, .map = view});
  };
  for (const ShadingModel model : {ShadingModel::BlinnPhong, ShadingModel::Phong}) {
    // A surface whose normal leans by an angle sees (1 + cosine) / 2 of the light of the sky.
    for (const float lean : {-0.9f, -0.3f, 0.0f, 0.5f, 1.0f}) {
      const float irradiance = 2 * (1 + lean) / 2;
      const float4 c = color(model, {0, lean, std::sqrt(1 - lean * lean)}, {0, 0, 0}, 1);
      expect_near(c, {0.5f * irradiance, 0.25f * irradiance, irradiance, 1}, 0.01f);
    }
    // Narrow highlights mirror the middle of the sky, and nothing below the horizon.
    const bool is_phong = model == ShadingModel::Phong;
    for (const float e : {10.0f, 40.0f}) {
      const float share = is_phong ? 2 / (e + 1) : 8 / (e + 2) * (1 - std::exp2(-(e + 2) / 2));
      const float4 above = color(model, {0, 1, 0}, {1, 1, 1}, e), below = color(model, {0, -1, 0}, {1, 1, 1}, e);
      EXPECT_NEAR(above.y, 0.25f * 2 + 2 * share, 0.03f * share + 0.003f) << e;
      EXPECT_NEAR(below.y, 0, 0.03f * share + 0.003f) << e;
    }
  }
}

TEST(Surface, OcclusionAttenuatesTheEnvironmentMapOfBlinnPhong) {
  const PreparedEnvironment map = sky();
  Scene scene = flat_triangle(ShadingModel::BlinnPhong, {1, 1, 1, 1}, {0.5f, 0.5f, 0.5f});
  scene.images = {{"occlusion", one_texel({51, 0, 0, 255})}};
  const ViewUniforms view{
      .eye = {0.25f, 0.25f, 4}, .environment = {2, 2, 2}, .map = map.view({.color = {1, 1, 1}}, {0, 1, 0})};
  const float open = color_of(scene, view).x;
  scene.materials[0].occlusion_texture.image = 0;
  EXPECT_NEAR(color_of(scene, view).x, 0.2f * open, 1e-6f);
  EXPECT_GT(open, 1.0f) << "irradiance of half the sky and the highlight";
}

/// A black or nearly black triangle that reflects ambient light.
Scene ambient_triangle(float diffuse) {
  Scene scene = flat_triangle(ShadingModel::BlinnPhong, {diffuse, diffuse, 0.5f, 1});
  Material& m = scene.materials[0];
  m.ambient = {0.5f, 0.25f, 0.75f};
  m.emissive = {0, 0, 0.125f};
  return scene;
}

TEST(Surface, AmbientLightDoesNotNeedDiffuseReflection) {
  // Light of 2 from all sides; half of it reflected in red, a quarter in green, and the diffuse term is next to
  // nothing.
  const ViewUniforms surroundings{.ambient_light = {2, 2, 2}};
  for (const float diffuse : {0.0f, 1e-44f, 1e-38f, 1e-20f, 2e-10f, 2.4e-10f, 1e-6f}) {
    Scene scene = ambient_triangle(diffuse);
    EXPECT_EQ(color_of(scene, {}), (float4{0, 0, 0.125f, 1})) << diffuse;
    expect_near(color_of(scene, surroundings), {1, 0.5f, 1.625f, 1}, 4e-7f);
    scene.lights = {sun({0, 0, -1})};
    expect_near(color_of(scene, surroundings), {1, 0.5f, 2.125f, 1}, 2e-6f);
    scene.materials[0].model = ShadingModel::Phong;
    expect_near(color_of(scene, surroundings), {1, 0.5f, 2.125f, 1}, 2e-6f);
  }
}

TEST(Surface, AmbientLightMeetsTexturesAndVertexColours) {
  const ViewUniforms surroundings{.ambient_light = {2, 2, 2}};
  for (const float diffuse : {0.0f, 1e-6f}) {
    Scene scene = ambient_triangle(diffuse);
    scene.images = {{"base", one_texel({255, 0, 255, 255})},
                    {"occlusion", one_texel({51, 0, 0, 255})},
                    {"emissive", one_texel({255, 255, 255, 255})}};
    Material& m = scene.materials[0];
    m.base_color_texture.image = 0, m.occlusion_texture.image = 1, m.emissive_texture.image = 2;
    scene.meshes[0].color.assign(3, float4{0.5f, 1, 1, 1});
    expect_near(color_of(scene, surroundings), {0.1f, 0, 0.3f + 0.125f, 1}, 1e-6f);
  }
}

TEST(Surface, EmissionAboveWhiteComesThrough) {
  Scene scene = flat_triangle();
  scene.materials[0].base_color = {0, 0, 0, 1};
  scene.materials[0].emissive = {1, 2, 1};
  scene.materials[0].emissive_texture.image = 0;
  scene.images = {{"sun", Plane<float4>(1, 1, float4{1e4f, 1e5f, 0.5f, 1})}};
  EXPECT_EQ(color_of(scene, {}), (float4{1e4f, 2e5f, 0.5f, 1}));
  EXPECT_EQ(color_of(scene, {.raw_colors = true}), (float4{1e4f, 2e5f, 0.5f, 1}));  // light is no code
  scene.images[0].pixels = Rgba16Image(1, 1, {32768, 32769, 1, 65535});
  const float4 deep = color_of(scene, {});
  EXPECT_NEAR(deep.x, std::pow((32768 / 65535.0 + 0.055) / 1.055, 2.4), 2e-8);
  EXPECT_NEAR(deep.y / 2 - deep.x, 1.0 / 65535 * 2.4 / 1.055 * std::pow((0.5 + 0.055) / 1.055, 1.4), 1e-7);
  EXPECT_NEAR(deep.z, 1 / 65535.0 / 12.92, 1e-12);
  EXPECT_EQ(color_of(scene, {.raw_colors = true}).z, 1 / 65535.0f);
}

TEST(Surface, SimpleConfigurationsAreExact) {
  Scene scene = flat_triangle(ShadingModel::BlinnPhong, {0.5f, 0.5f, 0.5f, 1}, {0.25f, 0.25f, 0.25f});

  // Light and viewer straight above: n·l = n·h = 1.
  scene.lights = {sun({0, 0, -1})};
  EXPECT_EQ(color_of(scene, {.eye = {0.25f, 0.25f, 3}}).x, 0.75f);

  // A light behind gives no diffuse light; with the viewer above, h has no direction, and 0^e = 0.
  scene.lights = {sun({0, 0, 1})};
  EXPECT_EQ(color_of(scene, {.eye = {0.25f, 0.25f, 3}}).x, 0.0f);

  // Two lights add up; intensity and colour scale.
  scene.lights = {sun({0, 0, -1}), sun({0, 0, -1}, {0.5f, 1, 2})};
  scene.lights[1].intensity = 2;
  EXPECT_EQ(color_of(scene, {.eye = {0.25f, 0.25f, 3}}), (float4{1.5f, 2.25f, 3.75f, 1}));
}

TEST(Surface, PhongReflectsTheLight) {
  Scene scene = flat_triangle(ShadingModel::Phong, {0, 0, 0, 1}, {1, 1, 1});
  Material& m = scene.materials[0];
  m.exponent = 3;
  scene.lights = {sun({0.6f, 0, -0.8f})};
  // Mirrored, the light leaves towards (0.6, 0, 0.8); an orthographic viewer above sees 0.8³.
  EXPECT_NEAR(color_of(scene, {.is_orthographic = true}).x, 0.512f, 1e-6);
  EXPECT_NEAR(color_of(scene, {.view_direction = {-0.6f, 0, -0.8f}, .is_orthographic = true}).x, 1, 1e-6);
}

/// A light above the point that color_of shades.
Light light_above(LightKind kind, float height) {
  Light light;
  light.kind = kind;
  light.position = {0.25f, 0.25f, height};
  return light;
}

TEST(Surface, LightsFadeWithDistance) {
  Scene scene = flat_triangle(ShadingModel::BlinnPhong);
  scene.lights = {light_above(LightKind::Point, 2)};
  scene.lights[0].intensity = 8;
  EXPECT_NEAR(color_of(scene, {}).x, 2, 1e-6);
  scene.lights[0].range = 4;
  EXPECT_NEAR(color_of(scene, {}).x, 2 * (1 - 1.0 / 16), 1e-6);
  scene.lights[0].range = 2;
  EXPECT_EQ(color_of(scene, {}).x, 0.0f);
  scene.lights[0].falloff = Falloff::Quadratic;
  scene.lights[0].attenuation = {1, 0.5f, 0.5f};
  EXPECT_NEAR(color_of(scene, {}).x, 2, 1e-6);
  // A light in the surface itself has no direction and gives no light, nor anything infinite.
  scene.lights[0].position = {0.25f, 0.25f, 0};
  scene.lights[0].falloff = Falloff::InverseSquare;
  scene.lights[0].range = INFINITY;
  EXPECT_EQ(color_of(scene, {}).x, 0.0f);
}

TEST(Surface, SpotsHaveAConeAndAPenumbra) {
  Scene scene = flat_triangle(ShadingModel::BlinnPhong);
  Light spot = light_above(LightKind::Spot, 1);
  spot.inner_cone = 0.2f, spot.outer_cone = 0.6f;
  for (const float angle : {0.0f, 0.1f, 0.3f, 0.5f, 0.7f}) {
    spot.direction = {std::sin(angle), 0, -std::cos(angle)};
    scene.lights = {spot};
    const double share = (std::cos(angle) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
    const double clamped = std::min(1.0, std::max(0.0, share));
    EXPECT_NEAR(color_of(scene, {}).x, clamped * clamped, 1e-5) << angle;
  }
}

TEST(Surface, MetallicRoughnessIsGltfsAppendixBWithAllItsLight) {
  Scene scene = flat_triangle();
  Material& m = scene.materials[0];
  m.base_color = {0.9f, 0.5f, 0.2f, 1};
  m.metallic = 0.25f, m.roughness = 0.5f;
  m.emissive = {0.125f, 0, 0};
  const float3 l = normalize({1, 0, 2}), v = normalize({-0.5f, 0.3f, 1});
  scene.lights = {sun(-l)};
  scene.lights[0].intensity = 3;
  const float4 color = color_of(scene, {.view_direction = -v, .is_orthographic = true});

  const double pi = 3.14159265358979323846;
  const float3 h = normalize(l + v);
  const double a2 = 0.0625, nl = l.z, nv = v.z, nh = h.z, vh = dot(v, h);
  const double d = a2 / (pi * std::pow(nh * nh * (a2 - 1) + 1, 2));
  const double vis = 0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
  // A mixture of a dielectric and a metal, each lobe with its gain, and what the dielectric's lobe leaves.
  using F = scalar::Lane<double>;
  const auto weights = SpecularFit<F>(0.5).at(nv);
  const auto lobe = [&](double f0) {
    return (f0 + (1 - f0) * std::pow(1 - vh, 5)) * specular_gain<F>(weights, f0).v * vis * d;
  };
  const auto expected = [&](double base) {
    const double below = 1 - specular_albedo<F>(weights, 0.04).v;
    return 3 * nl * (0.75 * (below * base / pi + lobe(0.04)) + 0.25 * lobe(base));
  };
  expect_near(color,
              {static_cast<float>(expected(0.9) + 0.125), static_cast<float>(expected(0.5)),
               static_cast<float>(expected(0.2)), 1},
              3e-6f);
}

TEST(Surface, AWhiteFurnaceIsWhiteAndOcclusionDarkensIt) {
  Scene scene = flat_triangle();
  scene.materials[0].metallic = 0;
  const ViewUniforms furnace{.eye = {0.25f, 0.5f, 3}, .environment = {1, 1, 1}};
  expect_near(color_of(scene, furnace), {1, 1, 1, 1}, 1e-6f);
  scene.materials[0].metallic = 1, scene.materials[0].roughness = 0.3f;
  expect_near(color_of(scene, furnace), {1, 1, 1, 1}, 1e-6f);

  scene.images = {{"", one_texel({51, 0, 0, 255})}};
  scene.materials[0].occlusion_texture.image = 0;
  scene.materials[0].occlusion_strength = 0.5f;
  expect_near(color_of(scene, furnace), {0.6f, 0.6f, 0.6f, 1}, 1e-6f);
  // Not the light of lamps.
  Scene bare = scene;
  bare.materials[0].occlusion_texture.image = -1;
  scene.lights = bare.lights = {sun({0, 0, -1})};
  EXPECT_EQ(color_of(scene, {.eye = {0, 0, 3}}), color_of(bare, {.eye = {0, 0, 3}}));
}

TEST(Surface, AVolumeIsAsThickAsItsInstanceIsScaledAlongTheRay) {
  Scene scene = flat_triangle();
  auto layers = std::make_shared<MaterialLayers>();
  layers->transmission = 1, layers->specular = 0, layers->ior = 1.25f;
  layers->thickness = 0.5f, layers->attenuation_distance = 1, layers->attenuation_color = {0.5f, 0.25f, 0.75f};
  scene.materials[0].metallic = 0, scene.materials[0].layers = layers;
  for (const float3 scale : {float3{1, 1, 1}, float3{2, 2, 2}, float3{2, 3, 0.25f}, float3{0.5f, 0.125f, 4}})
    for (const float3 to_viewer : {float3{0, 0, 1}, float3{0.6f, 0, 0.8f}, float3{0, -0.8f, 0.6f}}) {
      scene.instances[0].world_from_object = scaling(scale);
      const float3 point{0.25f * scale.x, 0.25f * scale.y, 0};
      const float4 color = color_of(scene, {.eye = point + to_viewer * 100.0f, .environment = {1, 1, 1}});
      // The ray inside by Snell's law, and its length where the object has a length of 1 along it.
      const double x = -to_viewer.x / 1.25, y = -to_viewer.y / 1.25, z = std::sqrt(1 - x * x - y * y);
      const double thickness = 0.5 / std::hypot(x / scale.x, y / scale.y, z / scale.z);
      const auto passed = [&](double part) { return static_cast<float>(std::pow(part, thickness)); };
      expect_near(color, {passed(0.5), passed(0.25), passed(0.75), 1}, 3e-6f);
    }
}

}  // namespace
}  // namespace zoneplate
