// SPDX-License-Identifier: Apache-2.0
// Transmissive surfaces in whole images: what is behind them, refracted, absorbed and blurred.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

constexpr int glass_width = 48, glass_height = 36;

/// A square of this size about (0, 0, z) that faces +Z.
void add_square(Scene& scene, float size, float z, const Material& material) {
  Mesh mesh;
  mesh.position = {{-size, -size, z}, {size, -size, z}, {size, size, z}, {-size, size, z}};
  mesh.normal.assign(4, {0, 0, 1});
  mesh.uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.index = {0, 1, 2, 0, 2, 3};
  mesh.material = static_cast<int>(scene.materials.size());
  scene.meshes.push_back(mesh);
  scene.objects.push_back("square");
  scene.instances.push_back(
      {static_cast<int>(scene.meshes.size()) - 1, static_cast<int>(scene.objects.size()) - 1, {}});
  scene.materials.push_back(material);
}

Material glowing(float3 color) {
  Material m;
  m.base_color = {0, 0, 0, 1}, m.emissive = color;
  return m;
}

Material glass(const MaterialLayers& layers, float roughness = 0) {
  Material m;
  m.metallic = 0, m.roughness = roughness;
  m.layers = std::make_shared<const MaterialLayers>(layers);
  return m;
}

/// A red and a green half before black, and a pane of the material in front.
Scene pane(const Material& material) {
  Scene scene;
  add_square(scene, 4, -2, glowing({1, 0, 0}));
  add_square(scene, 1, 0, material);
  Mesh right = scene.meshes[0];
  for (float3& p : right.position) p = {p.x < 0 ? 0 : p.x, p.y, -1.9f};
  right.material = 2;
  scene.meshes.push_back(right);
  scene.materials.push_back(glowing({0, 1, 0}));
  scene.objects.push_back("right half");
  scene.instances.push_back({2, 2, {}});
  return scene;
}

Camera from_front() {
  Camera camera;
  camera.is_orthographic = true, camera.half_height = 1.5f, camera.aspect = 0;
  camera.near = 0.1f, camera.far = 10;
  camera.world_from_camera = translation({0, 0, 3});
  return camera;
}

LinearImage picture(const Scene& scene, std::optional<Crop> crop = std::nullopt, int samples = 4) {
  return render(PreparedScene(scene), from_front(), {.samples = standard_pattern(samples)},
                {.width = glass_width, .height = glass_height, .crop = crop})
      .color;
}

TEST(Transmission, ClearGlassShowsWhatIsBehind) {
  // An index of refraction of 1 neither reflects nor bends light.
  MaterialLayers clear{.ior = 1, .transmission = 1};
  clear.specular = 0;
  const LinearImage seen = picture(pane(glass(clear)));
  EXPECT_EQ(seen(glass_width / 2 - 5, glass_height / 2), (Linear{1, 0, 0, 1}));
  EXPECT_EQ(seen(glass_width / 2 + 5, glass_height / 2), (Linear{0, 1, 0, 1}));
  clear.transmission = 0.5f;  // the other half would be diffuse, which no light reaches
  const LinearImage half = picture(pane(glass(clear)));
  EXPECT_EQ(half(glass_width / 2 - 5, glass_height / 2), (Linear{0.5f, 0, 0, 1}));
}

TEST(Transmission, RoughGlassBlursAndKeepsTheSum) {
  MaterialLayers rough{.ior = 1.5f, .transmission = 1};
  rough.specular = 0;
  const LinearImage sharp = picture(pane(glass(rough, 0))), blurred = picture(pane(glass(rough, 0.5f)));
  const int y = glass_height / 2, middle = glass_width / 2;
  EXPECT_EQ(sharp(middle - 3, y).g, 0);
  EXPECT_GT(blurred(middle - 3, y).g, 0.05f);
  EXPECT_NEAR(blurred(middle - 3, y).r + blurred(middle - 3, y).g, 1, 0.06f);
}

/// A grey wall from column -4 to `right`, and a pane before it, in white surroundings, without a background.
LinearImage pane_before_wall(float right, float roughness, bool is_transparent) {
  Scene scene;
  add_square(scene, 4, -0.5f, glowing({0.25f, 0.25f, 0.25f}));
  for (float3& p : scene.meshes[0].position) p.x = std::min(p.x, right);
  MaterialLayers rough{.ior = 1, .transmission = 1};
  rough.specular = 0;
  add_square(scene, 1, 0, glass(rough, roughness));
  scene.environment.color = {1, 1, 1};
  RenderOptions options{.width = glass_width, .height = glass_height};
  options.display.is_transparent = is_transparent, options.display.background = {0, 0, 0, 1};
  return render(PreparedScene(scene), from_front(), {.samples = standard_pattern(8)}, options).color;
}

TEST(Transmission, RoughGlassBeforeAnOpaqueWallIsOpaque) {
  for (const float roughness : {0.0f, 0.3f, 0.6f, 0.8f, 1.0f})
    for (const bool is_transparent : {true, false}) {
      const LinearImage seen = pane_before_wall(0.5f, roughness, is_transparent);
      for (const int x : {glass_width / 2 - 10, glass_width / 2,
                          glass_width / 2 + 4}) {  // the wall ends at the column glass_width / 2 + 6
        EXPECT_NEAR(seen(x, glass_height / 2).g, 0.25f, 2e-3f) << roughness << " " << x;
        EXPECT_NEAR(seen(x, glass_height / 2).a, 1, 1e-5f) << roughness << " " << x;
      }
      EXPECT_NEAR(seen(glass_width / 2 + 9, glass_height / 2).a, 0, 1e-3f) << roughness;
    }
}

TEST(Transmission, SilhouettesBehindGlassHaveNoHalo) {
  // The wall's end lies in a pixel, whose colour is that of the wall at its part of alpha: no white surroundings shine
  // through the glass twice.
  for (const float roughness : {0.0f, 0.3f, 1.0f}) {
    const LinearImage seen = pane_before_wall(0.52f, roughness, true);
    int partial = 0;
    for (int x = glass_width / 2 - 10; x < glass_width / 2 + 10; ++x) {
      const Linear c = seen(x, glass_height / 2);
      EXPECT_NEAR(c.g, 0.25f * c.a, 2e-3f) << roughness << " " << x;
      partial += c.a > 0.05f && c.a < 0.95f;
    }
    EXPECT_GT(partial, 0);
  }
}

TEST(Transmission, AVolumeAbsorbsAsItsThicknessSays) {
  MaterialLayers volume{.ior = 1, .transmission = 1, .thickness = 2, .attenuation_distance = 1};
  volume.specular = 0, volume.attenuation_color = {0.5f, 0.25f, 1};
  const LinearImage seen = picture(pane(glass(volume)));
  EXPECT_NEAR(seen(glass_width / 2 - 5, glass_height / 2).r, 0.25f, 1e-6f);
  EXPECT_NEAR(seen(glass_width / 2 + 5, glass_height / 2).g, 0.0625f, 1e-6f);
}

TEST(Transmission, GlassBeforeTheBackgroundIsTransparent) {
  MaterialLayers clear{.ior = 1, .transmission = 0.75f};
  clear.specular = 0;
  const auto alone = [&](const float4& color, bool has_environment_behind) {
    Scene scene;
    Material m = glass(clear);
    m.base_color = color;
    add_square(scene, 1, 0, m);
    scene.environment.color = {1, 1, 1};
    RenderOptions options{.width = glass_width, .height = glass_height};
    if (has_environment_behind) options.background.emplace();
    options.display.is_transparent = true;
    return render(PreparedScene(scene), from_front(), {.samples = standard_pattern(4)}, options)
        .color(glass_width / 2, glass_height / 2);
  };
  const auto expect = [](const Linear& c, const Linear& wanted) {
    EXPECT_NEAR(c.r, wanted.r, 1e-3f);
    EXPECT_NEAR(c.g, wanted.g, 1e-3f);
    EXPECT_NEAR(c.b, wanted.b, 1e-3f);
    EXPECT_NEAR(c.a, wanted.a, 1e-3f);
  };
  expect(alone({1, 1, 1, 1}, true), {1, 1, 1, 1});
  expect(alone({1, 1, 1, 1}, false), {0.25f, 0.25f, 0.25f, 0.25f});  // the diffuse part
  // Red passes wholly, of it as much as of the others through alpha, and the rest is the environment's.
  expect(alone({1, 0.2f, 0.2f, 1}, false), {1 - 0.15f, 0.2f - 0.15f, 0.2f - 0.15f, 0.85f});
}

TEST(Transmission, OpaqueGlassTransmitsBlackBeforeATransparentBackground) {
  MaterialLayers clear{.ior = 1, .transmission = 0.75f};
  clear.specular = 0;
  Scene scene;
  add_square(scene, 1, 0, glass(clear));
  scene.environment.color = {1, 1, 1};
  RenderOptions options{.width = glass_width, .height = glass_height};
  options.opaque_glass = true;
  options.display.is_transparent = true;
  const auto seen = [&] {
    return render(PreparedScene(scene), from_front(), {.samples = standard_pattern(4)}, options)
        .color(glass_width / 2, glass_height / 2);
  };
  const Linear alone = seen();  // the diffuse quarter
  EXPECT_NEAR(alone.r, 0.25f, 1e-3f);
  EXPECT_EQ(alone.a, 1);
  add_square(scene, 1, -1, glowing({0, 1, 0}));
  EXPECT_NEAR(seen().g, 1, 1e-3f);
}

TEST(Transmission, GlassColoursTheBackground) {
  MaterialLayers clear{.ior = 1, .transmission = 1};
  clear.specular = 0;
  Scene scene;
  Material red = glass(clear);
  red.base_color = {1, 0.25f, 0.5f, 1};
  add_square(scene, 1, 0, red);
  scene.environment.color = {1, 1, 1};
  RenderOptions options{.width = glass_width, .height = glass_height};
  options.display.background = {1, 1, 0, 1};
  const LinearImage image = render(PreparedScene(scene), from_front(), {.samples = standard_pattern(4)}, options).color;
  const Linear c = over_background(image, options.display)(glass_width / 2, glass_height / 2);
  EXPECT_NEAR(c.r, 1, 1e-3f);
  EXPECT_NEAR(c.g, 0.25f, 1e-3f);
  EXPECT_NEAR(c.b, 0, 1e-3f);
}

TEST(Transmission, GlassShowsBlendedSurfacesBehindIt) {
  MaterialLayers clear{.ior = 1, .transmission = 1};
  clear.specular = 0;
  Material veil = glowing({0, 0, 0.5f});
  veil.alpha_mode = AlphaMode::Blend, veil.base_color.w = 0.5f;
  for (const float z : {-1.0f, 1.0f}) {  // refracted behind the pane, composited in front of it
    Scene scene = pane(glass(clear));
    add_square(scene, 4, z, veil);
    EXPECT_EQ(picture(scene)(glass_width / 2 - 5, glass_height / 2), (Linear{0.5f, 0, 0.25f, 1})) << z;
  }
}

TEST(Transmission, GlassIsSeenThroughGlass) {
  MaterialLayers clear{.ior = 1, .transmission = 1};
  clear.specular = 0;
  const auto tinted = [&](float4 color) {
    Material m = glass(clear);
    m.base_color = color;
    return m;
  };
  Scene scene;
  add_square(scene, 4, -2, glowing({1, 1, 1}));
  add_square(scene, 4, -1, tinted({1, 0.5f, 1, 1}));
  add_square(scene, 4, 0, tinted({0.5f, 1, 1, 1}));
  EXPECT_EQ(picture(scene)(glass_width / 2, glass_height / 2), (Linear{0.5f, 0.5f, 1, 1}));
  // In any order in the file, and with others beside: each instance refracts the image of its own layer.
  std::swap(scene.instances[1], scene.instances[2]);
  EXPECT_EQ(picture(scene)(glass_width / 2, glass_height / 2), (Linear{0.5f, 0.5f, 1, 1}));
  add_square(scene, 4, 1, tinted({0.25f, 1, 0.5f, 1}));
  EXPECT_EQ(picture(scene)(glass_width / 2, glass_height / 2), (Linear{0.125f, 0.5f, 0.5f, 1}));
}

TEST(Transmission, ManyPanesAreSeenAsFourLayers) {
  MaterialLayers clear{.ior = 1, .transmission = 1};
  clear.specular = 0;
  Material grey = glass(clear);
  grey.base_color = {0.5f, 0.5f, 0.5f, 1};
  Scene scene;
  add_square(scene, 4, -2, glowing({1, 1, 1}));
  // The last two panes are the nearest to each other, and do not see each other.
  for (const float z : {-1.5f, -1.0f, -0.5f, 0.0f, 0.4f}) add_square(scene, 4, z, grey);
  const float seen = picture(scene)(glass_width / 2, glass_height / 2).r;
  EXPECT_EQ(seen, 0.0625f);
}

TEST(Transmission, AVolumeRefracts) {
  // A pane that is turned: behind its thickness d, light from the angle a is displaced along the pane.
  MaterialLayers volume{.ior = 1.5f, .transmission = 1, .thickness = 1};
  volume.specular = 0;
  Scene scene = pane(glass(volume));
  const float angle = 0.6f;
  scene.instances[1].world_from_object = rotation(Quaternion{0, std::sin(angle / 2), 0, std::cos(angle / 2)});
  const LinearImage seen = picture(scene);
  // Light enters at x; inside it runs at asin(sin a / 1.5) from the normal, to the right.
  const float inside = std::asin(std::sin(angle) / 1.5f), shift = std::sin(angle - inside);
  const float pixels = shift * glass_height / 3;
  ASSERT_GT(pixels, 2);
  const int y = glass_height / 2, middle = glass_width / 2, edge = static_cast<int>(std::lround(pixels));
  int first_green = 0;
  for (int x = middle - 9; x < middle + 9; ++x)
    if (seen(x, y).g > 0.5f && first_green == 0) first_green = x;
  EXPECT_NEAR(std::abs(first_green - middle), edge, 1);
}

TEST(Transmission, ACropHasTheBitsOfTheWholeImage) {
  MaterialLayers volume{.ior = 1.5f, .transmission = 1, .thickness = 0.5f, .dispersion = 3};
  const Scene scene = pane(glass(volume, 0.3f));
  const LinearImage whole = picture(scene);
  const Crop crop{15, 9, 20, 17};
  const LinearImage part = picture(scene, crop);
  for (int y = 0; y < crop.height; ++y)
    for (int x = 0; x < crop.width; ++x) ASSERT_EQ(part(x, y), whole(x + crop.x, y + crop.y)) << x << " " << y;
}

}  // namespace
}  // namespace zoneplate
