// SPDX-License-Identifier: Apache-2.0

// Light passes: the components of an image's light, against the image itself and against materials that have one
// component only.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"
#include "zoneplate/scene/fit.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

constexpr Planes light{.diffuse = true, .specular = true, .transmission = true, .emission = true};
enum Component { Diffuse, Specular, Transmission, Emission };

RenderedImage rendered(Scene scene, const std::string& method = "ssaa:n=4", const std::optional<Crop>& crop = {}) {
  light_unlit(scene);
  const Camera camera = fit_camera(scene, 4.0f / 3, {});
  Renderer renderer(PreparedScene(std::move(scene)), make_resolver(antialias::methods(), method));
  return renderer.render(
      camera, {.options = {.width = 80, .height = 60, .crop = crop}, .planes = light, .form = ImageForm::Linear});
}

/// A teapot of this material, which gets the default light: of metallic-roughness materials the studio, an environment
/// map.
Scene unlit_scene_of(const Material& material) {
  Scene scene = *make_builtin_scene("teapot:divisions=6");
  for (Material& m : scene.materials) m = material;
  return scene;
}

/// The same with lights and an environment of one colour.
Scene scene_of(const Material& material) {
  Scene scene = unlit_scene_of(material);
  scene.lights = default_lights();
  scene.environment.color = {0.5f, 0.6f, 0.7f};
  return scene;
}

Material layered(MaterialLayers layers, float4 color = {0.8f, 0.5f, 0.3f, 1}) {
  return {.base_color = color,
          .emissive = {0.05f, 0.1f, 0.2f},
          .metallic = 0.25f,
          .roughness = 0.4f,
          .layers = std::make_shared<const MaterialLayers>(std::move(layers))};
}

MaterialLayers all_layers() {
  return {.clearcoat = 0.6f,
          .clearcoat_roughness = 0.1f,
          .sheen_color = {0.3f, 0.2f, 0.1f},
          .sheen_roughness = 0.5f,
          .transmission = 0.4f,
          .thickness = 0.1f,
          .diffuse_transmission = 0.3f};
}

float greatest(float3 c) { return std::max({c.x, c.y, c.z}); }

float greatest(const Plane<float3>& plane) {
  float most = 0;
  for (const float3 c : plane.values()) most = std::max(most, greatest(c));
  return most;
}

void expect_sum(const RenderedImage& image) {
  float most = 0;
  for (std::size_t i = 0; i < image.linear.values().size(); ++i) {
    const Linear c = image.linear.values()[i];
    float3 sum{0, 0, 0};
    for (const Plane<float3>& plane : image.data.light) {
      const float3 part = plane.values()[i];
      EXPECT_GE(std::min({part.x, part.y, part.z}), 0);
      sum = sum + part;
    }
    const float3 off = sum - float3{c.r, c.g, c.b};
    most = std::max({most, std::abs(off.x), std::abs(off.y), std::abs(off.z)});
  }
  EXPECT_LT(most, 2e-6f * std::max(1.0f, greatest(image.data.light[Specular])));
}

const Material phong{
    .model = ShadingModel::BlinnPhong, .base_color = {0.8f, 0.5f, 0.3f, 1}, .specular = {0.4f, 0.4f, 0.4f}};
const Material metallic{.base_color = {0.8f, 0.5f, 0.3f, 1}, .metallic = 0.5f, .roughness = 0.4f};

TEST(LightPasses, AddUpToTheColor) {
  Material blended = metallic;
  blended.alpha_mode = AlphaMode::Blend, blended.base_color.w = 0.5f, blended.emissive = {0, 0.2f, 0};
  Material unlit = metallic;
  unlit.model = ShadingModel::Unlit;
  for (const Material& material : {phong, metallic, blended, unlit, layered(all_layers())})
    for (const char* const method : {"ssaa:n=4", "msaa:n=4", "none"}) expect_sum(rendered(scene_of(material), method));
}

TEST(LightPasses, AddUpToTheColorInAnEnvironmentMap) {
  for (const Material& material : {metallic, layered(all_layers())}) expect_sum(rendered(unlit_scene_of(material)));
}

/// The passes of a teapot of glass before a background, which beside the teapot is in no pass.
void expect_sum_of_glass(const Material& material, const RenderOptions& options) {
  Scene scene = unlit_scene_of(material);
  light_unlit(scene);
  const Camera camera = fit_camera(scene, 4.0f / 3, {});
  Renderer renderer(PreparedScene(std::move(scene)), make_resolver(antialias::methods(), "none"));
  Planes planes = light;
  planes.object_id = true;
  RenderedImage image = renderer.render(camera, {.options = options, .planes = planes, .form = ImageForm::Linear});
  EXPECT_GT(greatest(image.data.light[Transmission]), 0.02f);
  image.linear = over_background(std::move(image.linear), options.display);
  int beside = 0;
  for (std::size_t i = 0; i < image.linear.values().size(); ++i)
    if (image.data.object_id.values()[i] == UINT32_MAX) image.linear.values()[i] = {0, 0, 0, 0}, ++beside;
  EXPECT_GT(beside, 100);
  EXPECT_LT(beside, options.width * options.height - 500);
  expect_sum(image);
}

TEST(LightPasses, AddUpToTheColorOfGlassBeforeABackground) {
  MaterialLayers layers{.transmission = 1};
  Material clear = layered(layers, {1, 1, 1, 1});
  clear.metallic = 0, clear.roughness = 0;
  layers.sheen_color = {0.5f, 0.4f, 0.3f}, layers.sheen_roughness = 0.5f;
  Material rough = layered(layers);
  rough.metallic = 0, rough.roughness = 0.3f;
  RenderOptions environment{.width = 80, .height = 60, .background = EnvironmentBackground{}}, color = environment;
  color.background.reset(), color.display.background = {0.3f, 0.6f, 0.9f, 1};
  for (const Material& material : {clear, rough, layered(all_layers())}) {
    expect_sum_of_glass(material, environment);
    expect_sum_of_glass(material, color);
  }
}

TEST(LightPasses, TheColorStaysTheSame) {
  const Scene scene = scene_of(layered(all_layers()));
  const Camera camera = fit_camera(scene, 4.0f / 3, {});
  Renderer renderer(PreparedScene(scene), make_resolver(antialias::methods(), "ssaa:n=4"));
  const RenderedImage alone =
      renderer.render(camera, {.options = {.width = 80, .height = 60}, .form = ImageForm::Linear});
  EXPECT_EQ(alone.linear, rendered(scene).linear);
}

// A dielectric's specular light does not depend on its base colour, and black ones have no other.
TEST(LightPasses, TheSpecularLightOfADielectricIsThatOfABlackOne) {
  const auto expect_specular = [](Material material, Scene make(const Material&)) {
    material.metallic = 0, material.emissive = {0, 0, 0};
    const RenderedImage colored = rendered(make(material));
    material.base_color = {0, 0, 0, 1};
    const RenderedImage black = rendered(make(material));
    EXPECT_GT(greatest(colored.data.light[Diffuse]), 0.1f);
    float most = 0;
    for (std::size_t i = 0; i < black.linear.values().size(); ++i) {
      const Linear c = black.linear.values()[i];
      const float3 off = colored.data.light[Specular].values()[i] - float3{c.r, c.g, c.b};
      most = std::max({most, std::abs(off.x), std::abs(off.y), std::abs(off.z)});
    }
    EXPECT_LT(most, 2e-6f * std::max(1.0f, greatest(black.data.light[Specular])));
  };
  expect_specular(metallic, scene_of);
  expect_specular(metallic, unlit_scene_of);
  MaterialLayers layers = all_layers();
  layers.diffuse_transmission = 0;  // has a colour of its own
  expect_specular(layered(layers), scene_of);
}

TEST(LightPasses, MaterialsOfOneComponentHaveNoOther) {
  const auto expect_only = [](const Material& material, Component component) {
    const RenderedImage image = rendered(scene_of(material));
    for (std::size_t k = 0; k < image.data.light.size(); ++k) {
      if (k == component)
        EXPECT_GT(greatest(image.data.light[k]), 0.2f);
      else
        EXPECT_LT(greatest(image.data.light[k]), 2e-6f) << k;
    }
  };
  Material material = phong;
  material.specular = {0, 0, 0};
  expect_only(material, Diffuse);
  material = metallic, material.metallic = 1;
  expect_only(material, Specular);
  material = metallic, material.model = ShadingModel::Unlit;
  expect_only(material, Emission);
  material = layered({.specular = 0, .transmission = 1}, {1, 1, 1, 1});
  material.metallic = 0, material.emissive = {0, 0, 0};
  const RenderedImage glass = rendered(scene_of(material));
  EXPECT_LT(greatest(glass.data.light[Diffuse]), 2e-6f);
  EXPECT_EQ(greatest(glass.data.light[Emission]), 0);
}

TEST(LightPasses, ACropHasTheBitsOfTheWholeImage) {
  const Scene scene = scene_of(layered(all_layers()));
  const RenderedImage whole = rendered(scene), part = rendered(scene, "ssaa:n=4", Crop{21, 13, 30, 20});
  for (std::size_t k = 0; k < whole.data.light.size(); ++k)
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 30; ++x)
        ASSERT_EQ(part.data.light[k](x, y), whole.data.light[k](x + 21, y + 13)) << k << " " << x << " " << y;
}

TEST(LightPasses, BitsAreThoseOfEveryInstructionSetAndNumberOfThreads) {
  for (const Material& material : {phong, metallic, layered(all_layers())}) {
    const RenderedImage first = rendered(unlit_scene_of(material), "none");
    for (const Isa isa : supported_isas())
      with_isa(isa, [&] {
        with_threads(3, [&] {
          const RenderedImage image = rendered(unlit_scene_of(material), "none");
          for (std::size_t k = 0; k < image.data.light.size(); ++k)
            EXPECT_EQ(image.data.light[k], first.data.light[k]) << name_of(isa) << " " << k;
        });
      });
  }
}

TEST(LightPasses, MethodsWithAHistoryAreRefused) { EXPECT_THROW(rendered(scene_of(metallic), "taa"), Error); }

}  // namespace
}  // namespace zoneplate
