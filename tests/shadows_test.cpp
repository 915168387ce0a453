// SPDX-License-Identifier: Apache-2.0
// Shadows in images: where they may not be, where they must be, and what casts them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"
#include "zoneplate/scene/builtin/shapes.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

constexpr int shadow_width = 128, shadow_height = 96;
constexpr float pi = 3.14159265f;

/// A white diffuse material.
Material white(AlphaMode alpha_mode = AlphaMode::Opaque) {
  Material m;
  m.name = "white";
  m.model = ShadingModel::BlinnPhong;
  m.alpha_mode = alpha_mode;
  m.double_sided = true;
  return m;
}

/// A smooth sphere of few triangles around `centre`.
Mesh low_sphere(float3 centre, float radius, int columns, int rows) {
  Mesh mesh;
  const auto n = static_cast<std::uint32_t>(columns);
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const float theta = pi * static_cast<float>(y) / static_cast<float>(rows);
      const float phi = 2 * pi * static_cast<float>(x) / static_cast<float>(columns);
      const float3 d{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
      mesh.position.push_back(centre + d * radius), mesh.normal.push_back(normalize(d));
    }
  for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(rows); ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * n + x, b = y * n + (x + 1) % n;
      for (const std::uint32_t v : {a, b, a + n, b, b + n, a + n}) mesh.index.push_back(v);
    }
  return mesh;
}

Light sun_from(float3 to_light) {
  Light light;
  light.direction = -normalize(to_light);
  return light;
}

Frame shadow_frame(const Scene& scene, const RenderOptions& options = {}, Planes planes = {}) {
  RenderOptions all = options;
  all.width = shadow_width, all.height = shadow_height;
  Request request;
  request.planes = planes;
  return render(PreparedScene(scene), scene.cameras[0], request, all);
}

const RenderOptions hard{.shadows = {.method = ShadowMethod::Hard}};

/// A floor of 2 × 2 units in the plane y = 0, and a camera that looks at it from above.
Scene floor_scene(float side = 2) {
  Scene scene;
  Mesh floor;
  add_quad(floor,
           {{-side / 2, 0, side / 2}, {side / 2, 0, side / 2}, {side / 2, 0, -side / 2}, {-side / 2, 0, -side / 2}});
  add_part(scene, white(), std::move(floor));
  scene.cameras.push_back(camera_at({0, 3, 2}, {0, 0, 0}, 0.6f, 0.1f, 100));
  return scene;
}

/// The red of the pixel that shows a point of the world.
float red_at(const Frame& frame, const Camera& camera, float3 point) {
  const float4x4 clip =
      camera.clip_from_camera(static_cast<float>(shadow_width) / shadow_height) * inverse(camera.world_from_camera);
  const float4 p = clip * float4{point.x, point.y, point.z, 1};
  const float x = (p.x / p.w + 1) / 2 * shadow_width, y = (1 - p.y / p.w) / 2 * shadow_height;
  const bool is_seen = x >= 0 && x < shadow_width && y >= 0 && y < shadow_height;
  EXPECT_TRUE(is_seen);
  return is_seen ? frame.color(static_cast<int>(x), static_cast<int>(y)).r : 0;
}

// A convex surface receives all light that comes from above its horizon, however low, large or far from the origin it
// is. Smooth ones have lit fragments on triangles that face away from the light.
TEST(Shadows, ConvexSurfacesCastNoneOnThemselves) {
  int lit = 0;
  for (const float scale : {1e-3f, 1.0f, 1e4f})
    for (const float3 centre : {float3{0, 0, 0}, float3{300, -100, 70}})
      for (const float degrees : {0.0f, 30.0f, 60.0f, 80.0f, 85.0f, 89.0f, 100.0f, 140.0f}) {
        Scene scene;
        add_part(scene, white(), low_sphere(centre * scale, scale, 16, 8));
        Mesh floor, box;
        add_quad(floor, {{-3 * scale, 4 * scale, 0},
                         {3 * scale, 4 * scale, 0},
                         {3 * scale, 2 * scale, 0.1f * scale},
                         {-3 * scale, 2 * scale, 0.1f * scale}});
        for (float3& p : floor.position) p += centre * scale;
        add_part(scene, white(), std::move(floor));
        scene.cameras.push_back(camera_at((centre + float3{0, 1, 9}) * scale, (centre + float3{0, 1, 0}) * scale, 0.7f,
                                          scale, 100 * scale));
        const float a = degrees * pi / 180;
        // From the side, so that neither part shadows the other.
        scene.lights = {sun_from({std::sin(a), 0, std::cos(a)})};
        const Frame without = shadow_frame(scene), with = shadow_frame(scene, hard);
        for (int y = 0; y < shadow_height; ++y)
          for (int x = 0; x < shadow_width; ++x) {
            ASSERT_EQ(with.color(x, y), without.color(x, y))
                << scale << " " << centre.x << " " << degrees << "°: " << x << "," << y;
            lit += without.color(x, y).r > 0;
          }
      }
  EXPECT_GT(lit, 50000);
}

TEST(Shadows, BoxOnTheFloorLeavesNoGap) {
  Scene scene = floor_scene();
  Mesh box;
  add_box(box, {-0.3f, 0, -0.3f}, {0.3f, 0.6f, 0.3f});
  add_part(scene, white(), std::move(box));
  scene.lights = {sun_from({-1, 1, 0})};
  // Seen from the side of the shadow, which begins at the box.
  scene.cameras[0] = camera_at({1.6f, 1.5f, 0.1f}, {0.5f, 0, 0}, 0.8f, 0.1f, 100);
  const Frame frame = shadow_frame(scene, hard);
  for (int i = 0; i < 200; ++i) {
    const float x = 0.3001f + 0.57f * static_cast<float>(i) / 200;
    ASSERT_EQ(red_at(frame, scene.cameras[0], {x, 0, 0}), 0) << x;
  }
  EXPECT_GT(red_at(frame, scene.cameras[0], {0.93f, 0, 0}), 0.6f);
  EXPECT_GT(red_at(frame, scene.cameras[0], {0.4f, 0, 0.35f}), 0.6f);
}

TEST(Shadows, EveryKindOfLightHasThem) {
  Scene scene = floor_scene();
  Mesh sheet;
  add_quad(sheet, {{-0.2f, 0.5f, 0.2f}, {0.2f, 0.5f, 0.2f}, {0.2f, 0.5f, -0.2f}, {-0.2f, 0.5f, -0.2f}});
  add_part(scene, white(), std::move(sheet));
  Light point, spot;
  point.kind = LightKind::Point, spot.kind = LightKind::Spot;
  point.position = spot.position = {0, 2, 0};
  spot.direction = {0, -1, 0};
  scene.cameras[0] = camera_at({0, 0.4f, 3}, {0, 0, 0}, 0.7f, 0.1f, 100);
  for (const Light& light : {sun_from({0, 1, 0}), point, spot}) {
    scene.lights = {light};
    const Frame without = shadow_frame(scene), with = shadow_frame(scene, hard);
    for (const float x : {-0.15f, 0.0f, 0.15f}) {
      EXPECT_GT(red_at(without, scene.cameras[0], {x, 0, 0}), 0.1f);
      EXPECT_EQ(red_at(with, scene.cameras[0], {x, 0, 0}), 0);
    }
    // The shadow of a light at 2 units is 4/3 as wide as the sheet.
    EXPECT_EQ(red_at(with, scene.cameras[0], {0.24f, 0, 0}) == 0, light.kind != LightKind::Directional);
    for (const float x : {-0.5f, 0.3f})
      EXPECT_EQ(red_at(with, scene.cameras[0], {x, 0, 0}), red_at(without, scene.cameras[0], {x, 0, 0}));
  }
  // A light below the sheet is not blocked by it.
  point.position.y = 0.4f;
  scene.lights = {point};
  EXPECT_GT(red_at(shadow_frame(scene, hard), scene.cameras[0], {0, 0, 0}), 0.5f);
}

TEST(Shadows, AlphaOfCastersCounts) {
  Scene scene = floor_scene();
  Mesh sheet;
  add_quad(sheet, {{-0.4f, 0.5f, 0.4f}, {0.4f, 0.5f, 0.4f}, {0.4f, 0.5f, -0.4f}, {-0.4f, 0.5f, -0.4f}});
  Material veil = white(AlphaMode::Mask);
  veil.base_color_texture = {.image = 0, .sampler = {.magnify = TexelFilter::Nearest}};
  add_part(scene, veil, std::move(sheet));
  // The left half is a hole.
  Rgba8Image texels(2, 1, {255, 255, 255, 255});
  texels(0, 0).a = 64;
  scene.images.resize(1);
  scene.images[0].pixels = texels;
  scene.lights = {sun_from({0, 1, 0})};
  scene.cameras[0] = camera_at({0, 0.3f, 3}, {0, 0, 0}, 0.7f, 0.1f, 100);
  const Camera& camera = scene.cameras[0];
  const Frame masked = shadow_frame(scene, hard);
  EXPECT_NEAR(red_at(masked, camera, {-0.2f, 0, 0}), 1, 1e-5f);
  EXPECT_EQ(red_at(masked, camera, {0.2f, 0, 0}), 0);
  scene.materials[1].alpha_mode = AlphaMode::Blend;
  const Frame blended = shadow_frame(scene, hard);
  EXPECT_NEAR(red_at(blended, camera, {-0.2f, 0, 0}), 1 - 64 / 255.0f, 1e-3f);
  EXPECT_EQ(red_at(blended, camera, {0.2f, 0, 0}), 0);
}

TEST(Shadows, GlassPassesItsShare) {
  Scene scene = floor_scene();
  Mesh sheet;
  add_quad(sheet, {{-0.4f, 0.5f, 0.4f}, {0.4f, 0.5f, 0.4f}, {0.4f, 0.5f, -0.4f}, {-0.4f, 0.5f, -0.4f}});
  Material glass = white();
  glass.model = ShadingModel::MetallicRoughness;
  MaterialLayers layers;
  layers.transmission = 0.75f;
  glass.layers = std::make_shared<const MaterialLayers>(layers);
  add_part(scene, glass, std::move(sheet));
  scene.lights = {sun_from({0, 1, 0})};
  scene.cameras[0] = camera_at({0, 0.3f, 3}, {0, 0, 0}, 0.7f, 0.1f, 100);
  EXPECT_NEAR(red_at(shadow_frame(scene, hard), scene.cameras[0], {0, 0, 0}), 0.75f, 1e-5f);
}

// The edge of a sharp shadow across one large triangle: with one ray a pixel is either lit or not; rays from all over
// the pixel give its lit part.
TEST(Shadows, SoftOnesAreFilteredWithinPixels) {
  Scene scene = floor_scene(200);
  Mesh sheet;
  add_quad(sheet, {{-60, 1, 50}, {0.1f, 1, 50}, {-0.9f, 1, -50}, {-60, 1, -50}});
  add_part(scene, white(), std::move(sheet));
  scene.lights = {sun_from({0, 1, 0})};
  scene.cameras[0] = camera_at({2, 0.5f, 0}, {0, 0, 0}, 0.4f, 0.1f, 100);
  RenderOptions soft;
  soft.shadows = {.method = ShadowMethod::Soft, .samples = 64, .angle = 1e-4f};
  const auto grey = [&](const Frame& frame) {
    return std::ranges::count_if(frame.color.values(), [](Linear c) { return c.r > 0.05f && c.r < 0.95f; });
  };
  EXPECT_EQ(grey(shadow_frame(scene, hard)), 0);
  EXPECT_GT(grey(shadow_frame(scene, soft)), 60);
}

TEST(Shadows, OcclusionMultipliesTheEnvironmentsLight) {
  Scene scene = floor_scene();
  add_part(scene, white(), low_sphere({0, 0.5f, 0}, 0.5f, 64, 32));
  for (Material& m : scene.materials) m.model = ShadingModel::MetallicRoughness, m.metallic = 0;
  scene.environment.color = {1, 1, 1};
  RenderOptions options;
  options.occlusion = {.samples = 64, .distance = 100};
  const Frame without = shadow_frame(scene), with = shadow_frame(scene, options);
  for (const float z : {0.4f, 0.6f, 0.8f}) {
    const float part = red_at(with, scene.cameras[0], {0, 0, z}) / red_at(without, scene.cameras[0], {0, 0, z});
    EXPECT_NEAR(part, 1 - std::pow(0.5f / std::sqrt(0.25f + z * z), 3.0f), 0.04f);
  }
}

/// A sphere over nothing.
Scene floating_sphere() {
  Scene scene;
  add_part(scene, white(), low_sphere({0, 0.5f, 0}, 0.5f, 32, 16));
  scene.cameras.push_back(camera_at({0, 2, 4}, {0, 0.2f, 0}, 0.6f, 2, 6));
  scene.lights = {sun_from({0.5f, 1, 0.2f})};
  return scene;
}

TEST(Ground, HoldsTheShadowsAlone) {
  const Scene scene = floating_sphere();
  RenderOptions options = hard;
  options.ground = GroundKind::Shadow;
  const Planes planes{.depth = true, .normal = true, .object_id = true, .material_id = true, .primitive_id = true};
  const Frame without = shadow_frame(scene, hard, planes), with = shadow_frame(scene, options, planes);
  int shadowed = 0, clear = 0;
  for (int y = 0; y < shadow_height; ++y)
    for (int x = 0; x < shadow_width; ++x) {
      const Linear before = without.color(x, y), after = with.color(x, y);
      ASSERT_EQ(with.object_id(x, y), without.object_id(x, y));
      ASSERT_EQ(with.material_id(x, y), without.material_id(x, y));
      ASSERT_EQ(with.primitive_id(x, y), without.primitive_id(x, y));
      ASSERT_EQ(with.normal(x, y), without.normal(x, y));
      ASSERT_TRUE(with.depth(x, y) == without.depth(x, y) || std::abs(with.depth(x, y) - without.depth(x, y)) < 1e-4f);
      if (before.a > 0) {
        ASSERT_EQ(after.r, before.r);
        continue;
      }
      ASSERT_TRUE(after.a == 0 || after.a == 1);
      ASSERT_EQ(after.r, 0);
      (after.a == 1 ? shadowed : clear) += 1;
    }
  EXPECT_GT(shadowed, 100);
  EXPECT_GT(clear, 1000);
  options.shadows.method = ShadowMethod::None;
  EXPECT_THROW(shadow_frame(scene, options), Error);
}

// The shadow falls towards the camera and away from it, beyond the far plane of the camera itself.
TEST(Ground, ReachesAsFarAsShadowsDo) {
  Scene scene = floating_sphere();
  RenderOptions options = hard;
  options.ground = GroundKind::Shadow;
  for (const float side : {-1.0f, 1.0f}) {
    scene.lights = {sun_from({0, 0.6f, side})};
    const auto pixels_of_shadow = [&](float near, float far) {
      scene.cameras[0] = camera_at({0, 4, 1}, {0, 0.5f, 0}, 1.2f, near, far);
      const Frame frame = shadow_frame(scene, options);
      return std::ranges::count_if(frame.color.values(), [](Linear c) { return c.a == 1 && c.r == 0; });
    };
    EXPECT_GT(pixels_of_shadow(0.1f, 100), 40);
    EXPECT_EQ(pixels_of_shadow(3.0f, 4.3f), pixels_of_shadow(0.1f, 100));
  }
}

// Neighbours share rays where light and occlusion are smooth: the same image from a fraction of them. The error is that
// to a reference of 1024 rays.
TEST(Shadows, SharedRaysAreNearerToTheReference) {
  Scene scene = floor_scene(4);
  add_part(scene, white(), low_sphere({0, 0.5f, 0}, 0.5f, 64, 32));
  for (Material& m : scene.materials) m.model = ShadingModel::MetallicRoughness, m.metallic = 0;
  scene.environment.color = {0.5f, 0.5f, 0.5f};
  scene.lights = {sun_from({0.5f, 1, 0.2f})};
  for (const bool is_orthographic : {false, true}) {
    if (is_orthographic) scene.cameras[0].is_orthographic = true, scene.cameras[0].half_height = 1;
    const auto image = [&](int samples, int spacing) {
      RenderOptions options;
      options.shadows = {.method = ShadowMethod::Soft, .samples = samples, .angle = 0.1f, .spacing = spacing};
      options.occlusion = {.samples = samples, .distance = 2, .spacing = spacing};
      return shadow_frame(scene, options);
    };
    const Frame reference = image(1024, 1);
    const auto error = [&](const Frame& frame) {
      double sum = 0;
      for (std::size_t i = 0; i < frame.color.values().size(); ++i)
        sum += std::pow(frame.color.values()[i].r - reference.color.values()[i].r, 2);
      return std::sqrt(sum / (shadow_width * shadow_height));
    };
    const double own = error(image(32, 1)), shared = error(image(32, 4));
    EXPECT_LT(shared, own) << is_orthographic;
    EXPECT_LT(shared, 0.008);
    EXPECT_GT(shared, 1e-5);
  }
}

// Neither where there are few of them, nor for one of two queries.
TEST(Shadows, RaysAreSharedOnlyWhereAsked) {
  Scene scene = floor_scene(4);
  add_part(scene, white(), low_sphere({0, 0.5f, 0}, 0.5f, 64, 32));
  for (Material& m : scene.materials) m.model = ShadingModel::MetallicRoughness, m.metallic = 0;
  scene.environment.color = {0.5f, 0.5f, 0.5f};
  scene.lights = {sun_from({0.5f, 1, 0.2f})};
  const auto image = [&](int samples, int of_lights, int of_occlusion) {
    RenderOptions options;
    options.shadows = {.method = ShadowMethod::Soft, .samples = samples, .angle = 0.1f, .spacing = of_lights};
    options.occlusion = {.samples = samples, .distance = 2, .spacing = of_occlusion};
    return shadow_frame(scene, options).color;
  };
  EXPECT_TRUE(image(15, 8, 8) == image(15, 1, 1));
  EXPECT_FALSE(image(16, 8, 1) == image(16, 1, 1));
  EXPECT_FALSE(image(16, 1, 8) == image(16, 1, 1));
  // Without lights, those that would be shared have no part in the image.
  scene.lights.clear();
  EXPECT_TRUE(image(16, 8, 1) == image(16, 1, 1));
}

TEST(ShadowsBits, AreTheSameForAllThreadsAndInstructionSets) {
  Scene scene = floating_sphere();
  RenderOptions options;
  options.shadows = {.method = ShadowMethod::Soft, .angle = 0.2f};
  options.ground = GroundKind::Shadow;
  scene.environment.color = {0.2f, 0.2f, 0.3f};
  for (const int spacing : {1, 8}) {
    options.shadows.samples = spacing == 1 ? 8 : 16, options.occlusion.samples = spacing == 1 ? 4 : 16;
    options.shadows.spacing = options.occlusion.spacing = spacing;
    const Frame first = with_isa(Isa::Scalar, [&] { return shadow_frame(scene, options); });
    for (const Isa isa : supported_isas())
      for (const int threads : {1, 3})
        with_isa(isa, [&] {
          with_threads(threads,
                       [&] { EXPECT_TRUE(shadow_frame(scene, options).color == first.color) << name_of(isa); });
        });
  }
}

}  // namespace
}  // namespace zoneplate
