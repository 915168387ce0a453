#include "zoneplate/shade/surface/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/shade/surface/material_plan.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

/// A scene of one triangle with corners (0,0,0), (1,0,0), (0,1,0), that faces +Z, u to the right and v downwards.
Scene is_flat_run() {
  Scene scene;
  Mesh mesh;
  mesh.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normal = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.uv0 = {{0, 1}, {1, 1}, {0, 0}};
  mesh.index = {0, 1, 2};
  scene.meshes = {mesh};
  scene.instances = {{0, 0, {}}};
  scene.objects = {"triangle"};
  scene.materials = {{}};
  return scene;
}

Light sun(float3 direction, float3 color = {1, 1, 1}) {
  Light light;
  light.direction = direction;
  light.color = color;
  return light;
}

Rgba8Image one_texel(Rgba8 value) { return Rgba8Image(1, 1, value); }

/// ShadingState of the scene's triangle, by their barycentric weights.
struct Hand {
  FragmentBatch batch;

  Hand() { std::memset(static_cast<void*>(&batch), 0, sizeof batch); }
  Hand(std::initializer_list<float3> weights) : Hand() {
    for (const float3 w : weights) add(w);
    pad();
  }
  void add(float3 w, std::uint32_t instance = 0, bool is_front = true) {
    const auto i = static_cast<std::size_t>(batch.count++);
    batch.triangle[i] = instance;
    batch.instance[i] = instance;
    for (std::uint32_t k = 0; k < 3; ++k) batch.vertex[k][i] = k;
    batch.is_front[i] = is_front ? 1 : 0;
    batch.b[0][i] = w.y, batch.b[1][i] = w.z;
  }
  /// Entries after the last repeat it.
  void pad() {
    const auto last = static_cast<std::size_t>(batch.count - 1);
    for (auto i = static_cast<std::size_t>(batch.count); i < static_cast<std::size_t>(batch.padded()); ++i) {
      batch.triangle[i] = batch.triangle[last], batch.instance[i] = batch.instance[last];
      batch.is_front[i] = batch.is_front[last];
      for (std::size_t k = 0; k < 3; ++k) batch.vertex[k][i] = batch.vertex[k][last];
      for (std::size_t k = 0; k < 2; ++k) {
        batch.b[k][i] = batch.b[k][last];
        batch.dbdx[k][i] = batch.dbdx[k][last], batch.dbdy[k][i] = batch.dbdy[k][last];
      }
    }
  }
};

/// A scene with all that its shader refers to.
struct Surfaces {
  TextureSet textures;
  InterleavedVertices vertices;
  SurfaceShader shader;
  Surfaces(const Scene& scene, ViewUniforms view)
      : textures(scene, view.raw_colors),
        vertices(scene),
        shader(scene, with_lights(view, scene), textures, vertices) {}
  static ViewUniforms& with_lights(ViewUniforms& view, const Scene& scene) {
    view.lights = scene.lights;
    return view;
  }
};

struct Outcome {
  FragmentOutputs shaded;
  float4 color(std::size_t i = 0) const { return {shaded.r[i], shaded.g[i], shaded.b[i], shaded.a[i]}; }
  float3 normal(std::size_t i = 0) const { return {shaded.normal[0][i], shaded.normal[1][i], shaded.normal[2][i]}; }
};

std::unique_ptr<Outcome> shade(const Scene& scene, const ViewUniforms& view, const Hand& hand) {
  auto outcome = std::make_unique<Outcome>();
  std::memset(static_cast<void*>(outcome.get()), 0, sizeof *outcome);
  FragmentOutputs& shaded = outcome->shaded;
  Surfaces(scene, view).shader.shade(hand.batch, {.normal = true, .uv = true, .albedo = true}, shaded);
  // What lies behind the points within a vector means nothing.
  const int end = hand.batch.padded(),
            whole = (end + FragmentBatch::max_lanes - 1) / FragmentBatch::max_lanes * FragmentBatch::max_lanes;
  for (std::size_t a = 0; a < sizeof shaded / (FragmentBatch::padded_capacity * sizeof(float)); ++a)
    std::fill(shaded.r + a * FragmentBatch::padded_capacity + end,
              shaded.r + a * FragmentBatch::padded_capacity + whole, 0.0f);
  return outcome;
}

float4 color_of(const Scene& scene, const ViewUniforms& view, float3 weights = {0.5f, 0.25f, 0.25f}) {
  return shade(scene, view, Hand{weights})->color();
}

void expect_near(float4 actual, float4 expected, float tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
  EXPECT_NEAR(actual.w, expected.w, tolerance);
}

TEST(Surface, UnlitIsTheBaseColour) {
  Scene scene = is_flat_run();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.materials[0].base_color = {0.25f, 0.5f, 2, 0.5f};
  scene.materials[0].emissive = {1, 1, 1};
  scene.lights = {sun({0, 0, -1})};
  EXPECT_EQ(color_of(scene, {}), (float4{0.25f, 0.5f, 2, 1}));
}

TEST(Surface, AlphaModesSayWhatAlphaMeans) {
  Scene scene = is_flat_run();
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
  Scene scene = is_flat_run();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.meshes[0].color = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  EXPECT_EQ(color_of(scene, {}, {0.5f, 0.375f, 0.125f}), (float4{0.5f, 0.375f, 0.125f, 1}));
}

/// base (ambient + max(n·l, 0)) + specular max(n·h, 0)^shininess, in double.
double benchmark(double base, double ambient, double nl, double specular, double nh, double shininess) {
  return base * (ambient + std::max(nl, 0.0)) + specular * std::pow(std::max(nh, 0.0), shininess);
}

TEST(Surface, BlinnPhongIsTheTextbooksFormula) {
  Scene scene = is_flat_run();
  Material& m = scene.materials[0];
  m.model = ShadingModel::BlinnPhong;
  m.base_color = {0.8f, 0.55f, 0.3f, 1};
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

/// A black or nearly black triangle that reflects ambient light.
Scene ambient_triangle(float diffuse) {
  Scene scene = is_flat_run();
  Material& m = scene.materials[0];
  m.model = ShadingModel::BlinnPhong;
  m.base_color = {diffuse, diffuse, 0.5f, 1};
  m.ambient = {0.5f, 0.25f, 0.75f};
  m.emissive = {0, 0, 0.125f};
  return scene;
}

TEST(Surface, AmbientLightDoesNotNeedDiffuseReflection) {
  // Light of 2 from all sides; half of it reflected in red, a quarter in green, and the diffuse term is next to
  // nothing.
  const ViewUniforms view{.ambient_light = {2, 2, 2}};
  for (const float diffuse : {0.0f, 1e-44f, 1e-38f, 1e-20f, 2e-10f, 2.4e-10f, 1e-6f}) {
    Scene scene = ambient_triangle(diffuse);
    EXPECT_EQ(color_of(scene, {}), (float4{0, 0, 0.125f, 1})) << diffuse;
    expect_near(color_of(scene, view), {1, 0.5f, 1.625f, 1}, 4e-7f);
    scene.lights = {sun({0, 0, -1})};
    expect_near(color_of(scene, view), {1, 0.5f, 2.125f, 1}, 2e-6f);
    scene.materials[0].model = ShadingModel::Phong;
    expect_near(color_of(scene, view), {1, 0.5f, 2.125f, 1}, 2e-6f);
  }
}

TEST(Surface, AmbientLightMeetsTexturesAndVertexColours) {
  const ViewUniforms view{.ambient_light = {2, 2, 2}};
  for (const float diffuse : {0.0f, 1e-6f}) {
    Scene scene = ambient_triangle(diffuse);
    scene.images = {{"base", one_texel({255, 0, 255, 255})},
                    {"occlusion", one_texel({51, 0, 0, 255})},
                    {"emissive", one_texel({255, 255, 255, 255})}};
    Material& m = scene.materials[0];
    m.base_color_texture.image = 0, m.occlusion_texture.image = 1, m.emissive_texture.image = 2;
    scene.meshes[0].color.assign(3, float4{0.5f, 1, 1, 1});
    expect_near(color_of(scene, view), {0.1f, 0, 0.3f + 0.125f, 1}, 1e-6f);
  }
}

TEST(Surface, EmissionAboveWhiteComesThrough) {
  Scene scene = is_flat_run();
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
  Scene scene = is_flat_run();
  Material& m = scene.materials[0];
  m.model = ShadingModel::BlinnPhong;
  m.base_color = {0.5f, 0.5f, 0.5f, 1};
  m.specular = {0.25f, 0.25f, 0.25f};

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
  Scene scene = is_flat_run();
  Material& m = scene.materials[0];
  m.model = ShadingModel::Phong;
  m.base_color = {0, 0, 0, 1};
  m.specular = {1, 1, 1};
  m.exponent = 3;
  scene.lights = {sun({0.6f, 0, -0.8f})};
  // Mirrored, the light leaves towards (0.6, 0, 0.8); an orthographic viewer above sees 0.8³.
  EXPECT_NEAR(color_of(scene, {.is_orthographic = true}).x, 0.512f, 1e-6);
  EXPECT_NEAR(color_of(scene, {.view_direction = {-0.6f, 0, -0.8f}, .is_orthographic = true}).x, 1, 1e-6);
}

TEST(Surface, LightsFadeWithDistance) {
  Scene scene = is_flat_run();
  scene.materials[0].model = ShadingModel::BlinnPhong;
  Light light;
  light.kind = LightKind::Point;
  light.position = {0.25f, 0.25f, 2};
  light.intensity = 8;
  scene.lights = {light};
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
  Scene scene = is_flat_run();
  scene.materials[0].model = ShadingModel::BlinnPhong;
  Light spot;
  spot.kind = LightKind::Spot;
  spot.position = {0.25f, 0.25f, 1};
  spot.inner_cone = 0.2f, spot.outer_cone = 0.6f;
  for (const float angle : {0.0f, 0.1f, 0.3f, 0.5f, 0.7f}) {
    spot.direction = {std::sin(angle), 0, -std::cos(angle)};
    scene.lights = {spot};
    const double share = (std::cos(angle) - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6));
    const double clamped = std::min(1.0, std::max(0.0, share));
    EXPECT_NEAR(color_of(scene, {}).x, clamped * clamped, 1e-5) << angle;
  }
}

TEST(Surface, MetallicRoughnessIsGltfsAppendixB) {
  Scene scene = is_flat_run();
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
  const auto expected = [&](double base) {
    const double f0 = 0.04 * 0.75 + base * 0.25, f = f0 + (1 - f0) * std::pow(1 - vh, 5);
    return 3 * nl * ((1 - f) * base * 0.75 / pi + f * vis * d);
  };
  expect_near(color,
              {static_cast<float>(expected(0.9) + 0.125), static_cast<float>(expected(0.5)),
               static_cast<float>(expected(0.2)), 1},
              3e-6f);
}

TEST(Surface, AWhiteFurnaceIsWhiteAndOcclusionDarkensIt) {
  Scene scene = is_flat_run();
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

TEST(Surface, BackFacesTurnTheirNormals) {
  Scene scene = is_flat_run();
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
  Scene scene = is_flat_run();
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
  Scene scene = is_flat_run();
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
  Scene scene = is_flat_run();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.materials[0].base_color = {0.5f, 1, 1, 1};
  scene.images = {{"", one_texel({255, 128, 0, 255})}};
  scene.materials[0].base_color_texture.image = 0;
  EXPECT_EQ(color_of(scene, {.raw_colors = true}), (float4{0.5f, 128 * (1 / 255.0f), 0, 1}));
  EXPECT_NEAR(color_of(scene, {}).y, std::pow((128 / 255.0 + 0.055) / 1.055, 2.4), 1e-5);
  EXPECT_EQ(color_of(scene, {}).x, 0.5f);
}

TEST(Surface, TextureTransformsScaleThenRotateThenMove) {
  Scene scene = is_flat_run();
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
  Scene scene = is_flat_run();
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
  Scene scene = is_flat_run();
  Material& m = scene.materials[0];
  m.model = ShadingModel::BlinnPhong;
  m.ambient = m.emissive = {1, 1, 1};
  Rgba8Image halves(2, 1), wide(4, 1, {0, 0, 255, 255});
  halves(0, 0) = {255, 0, 0, 255}, halves(1, 0) = {0, 255, 0, 255};
  wide(1, 0) = {0, 255, 255, 255};
  scene.images = {{"", halves}, {"", wide}};
  const Sampler nearest{.magnify = TexelFilter::Nearest};
  const ViewUniforms view{.ambient_light = {1, 1, 1}};
  m.base_color_texture = {.image = 0, .sampler = nearest};
  const float3 at{0.75f, 0.25f, 0};  // u = 0.25

  m.emissive_texture = m.base_color_texture;
  EXPECT_EQ(color_of(scene, view, at), (float4{2, 0, 0, 1}));
  m.emissive_texture.offset = {0.5f, 0};
  EXPECT_EQ(color_of(scene, view, at), (float4{1, 1, 0, 1}));
  m.emissive_texture = {.image = 1, .sampler = nearest};
  EXPECT_EQ(color_of(scene, view, at), (float4{1, 1, 1, 1}));
  m.emissive_texture = {.image = 0, .sampler = {}};
  EXPECT_EQ(color_of(scene, view, at), (float4{2, 0, 0, 1}));
}

/// Materials that use images 0 and 2 as colours, 0 as data too; nothing uses image 1.
Scene textured_scene() {
  Scene scene = is_flat_run();
  scene.images = {{"both", one_texel({1, 2, 3, 4})}, {"unused", one_texel({})}, {"color", one_texel({5, 6, 7, 8})}};
  Material& m = scene.materials[0];
  m.base_color_texture.image = 0, m.normal_texture.image = 0, m.emissive_texture.image = 2, m.emissive = {1, 1, 1};
  scene.materials.push_back(m);
  scene.materials[1].emissive = {0, 0, 0}, scene.materials[1].emissive_texture.image = 1;
  return scene;
}

TEST(TextureSet, AnImageIsThereOnceForEachMeaning) {
  const Scene scene = textured_scene();
  const TextureSet set(scene, false), raw(scene, true);
  const auto find = [](const TextureSet& in, int image, TexelMeaning meaning) {
    return in.find({.image = image}, meaning);
  };
  EXPECT_NE(find(set, 0, TexelMeaning::Color), find(set, 0, TexelMeaning::Values));
  EXPECT_EQ(find(raw, 0, TexelMeaning::Color), find(raw, 0, TexelMeaning::Values));
  EXPECT_EQ(find(set, 1, TexelMeaning::Color), nullptr);  // black emission shows no texture
  EXPECT_NE(find(set, 2, TexelMeaning::Color), nullptr);
  EXPECT_EQ(find(set, -1, TexelMeaning::Color), nullptr);
}

TEST(TextureSet, TakesTheImagesWithIt) {
  Scene scene = textured_scene();
  const TextureSet kept(scene, false), taken = TextureSet::take(scene, false);
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
    const TextureSet again(scene, false);
    ADD_FAILURE() << "textures of images that are not there";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "texture both: has no texels");
  }
}

TEST(Surface, AlphaStaysBetweenZeroAndOne) {
  Scene scene = is_flat_run();
  scene.materials[0].model = ShadingModel::Unlit;
  scene.materials[0].alpha_mode = AlphaMode::Blend;
  scene.materials[0].base_color = {0.5f, 0.25f, 1, 3};
  EXPECT_EQ(color_of(scene, {}), (float4{0.5f, 0.25f, 1, 1}));
  float alpha[FragmentBatch::capacity];
  Surfaces(scene, {}).shader.alpha(Hand{{0.5f, 0.25f, 0.25f}}.batch, alpha);
  EXPECT_EQ(alpha[0], 1.0f);
}

TEST(Surface, MeshesWithoutNormalsAreUnlit) {
  Scene scene = is_flat_run();
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
  Scene scene = is_flat_run();
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
  EXPECT_EQ(word, 2234562064u);
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
