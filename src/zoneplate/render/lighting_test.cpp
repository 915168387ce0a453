// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/lighting.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/scene/default_lights.h"
#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/environment/studio.h"
#include "zoneplate/shade/reflection/brdf.h"

namespace zoneplate {
namespace {

constexpr float3 dim{default_environment, default_environment, default_environment};

TEST(Lighting, LightsASceneThatHasNoLight) {
  Scene scene;
  light_unlit(scene);
  EXPECT_EQ(scene.environment.factor(), dim);
  EXPECT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.ambient_light, dim);
}

TEST(Lighting, APhongSceneIsAsBrightAsOneWithoutLight) {
  Scene phong, unlit;
  phong.materials.push_back({.model = ShadingModel::BlinnPhong});
  unlit.materials.push_back({.model = ShadingModel::Unlit});
  light_unlit(phong);
  light_unlit(unlit);
  EXPECT_FLOAT_EQ(phong.lights[0].intensity * 3.14159265f, unlit.lights[0].intensity);
}

TEST(Lighting, SurfacesWithoutAMaterialHaveMoreContrast) {
  Scene plain, white;
  plain.materials.push_back({.model = ShadingModel::BlinnPhong, .is_default = true});
  white.materials.push_back({.model = ShadingModel::BlinnPhong});
  // Of a surface that faces the key light, and of one that no light reaches.
  const auto brightest = [](const Scene& scene) {
    const Lighting lighting = make_lighting(scene);
    return lighting.environment.factor().x + lighting.lights.front().intensity;
  };
  const auto darkest = [](const Scene& scene) { return make_lighting(scene).environment.factor().x; };
  EXPECT_NEAR(brightest(plain), brightest(white), 0.05f);
  EXPECT_LT(darkest(plain), 0.6f * darkest(white));
  EXPECT_EQ(make_lighting(plain).ambient_light.x, darkest(plain));
  plain.materials.push_back({.model = ShadingModel::BlinnPhong});
  EXPECT_EQ(darkest(plain), darkest(white));
}

TEST(Lighting, MetallicRoughnessIsLitByTheStudio) {
  Scene scene;
  scene.materials.push_back({.model = ShadingModel::MetallicRoughness});
  int made = 0;
  const auto studio = std::make_shared<const PreparedEnvironment>(studio_cube(32));
  const Lighting lighting = make_lighting(scene, {.intensity = 2, .studio = [&] {
                                                    ++made;
                                                    return studio;
                                                  }});
  EXPECT_EQ(made, 1);
  EXPECT_EQ(lighting.environment.map, studio);
  EXPECT_TRUE(lighting.environment.is_in_camera_space);
  EXPECT_EQ(lighting.environment.strength, 2);
  ASSERT_EQ(lighting.lights.size(), 1u);
  EXPECT_TRUE(lighting.lights[0].is_in_camera_space);
  EXPECT_EQ(lighting.lights[0].intensity, 2 * studio_key_lux);
  // The light comes from the brightest box.
  const EnvironmentView view = studio->view({.color = {1, 1, 1}}, {0, 1, 0});
  const auto light_from = [&](float3 d) {
    return specular_light(view, Vector<scalar::Float>{d.x, d.y, d.z}, scalar::Float(0.2f)).x.v;
  };
  const float key = light_from(-lighting.lights[0].direction);
  for (const float3 d : {float3{0, 0, 1}, float3{1, 0, 0}, float3{0, 1, 0}, float3{-1, 0, 0}, float3{0, 0, -1}})
    EXPECT_GT(key, 1.5f * light_from(d));
  EXPECT_EQ(lighting.ambient_light, float3{}) << "surfaces reflect the image by their normals";
  EXPECT_EQ(lighting.tone_mapping, ToneMapping::Neutral);
}

TEST(Lighting, OnlyTheStudioAloneBringsAToneCurve) {
  const auto studio = std::make_shared<const PreparedEnvironment>(studio_cube(4));
  const auto curve = [&](const Scene& scene, LightingOptions options) {
    options.studio = [&] { return studio; };
    return make_lighting(scene, options).tone_mapping;
  };
  Scene plaster, metal, own;
  plaster.materials.push_back({.model = ShadingModel::BlinnPhong});
  metal.materials.push_back({.model = ShadingModel::MetallicRoughness});
  own = metal;
  own.lights.resize(1);
  EXPECT_EQ(curve(plaster, {}), ToneMapping::None);
  EXPECT_EQ(curve(metal, {.environment = Environment{.color = {1, 1, 1}}}), ToneMapping::None);
  EXPECT_EQ(curve(own, {}), ToneMapping::None);
  EXPECT_EQ(curve(own, {.source = LightSource::Both}), ToneMapping::None);
  EXPECT_EQ(curve(own, {.source = LightSource::Default}), ToneMapping::Neutral);
}

TEST(Lighting, TheStudioShowsAWhiteSurfaceJustBelowWhite) {
  const PreparedEnvironment studio = prepare_studio();
  const EnvironmentView view = studio.view({.color = {1, 1, 1}}, {0, 1, 0});
  const float3 key = studio_key();
  const auto diffuse = [&](float3 n) {
    const float light = diffuse_light(view, Vector<scalar::Float>{n.x, n.y, n.z}).x.v;
    return light + std::max(dot(n, key), 0.0f) * studio_key_lux / 3.14159265f;
  };
  const auto code_of = [&](float reflectance, float3 n) {
    const float light = 0.04f + 0.96f * reflectance * diffuse(n);  // a dielectric, which reflects about 4 %
    return static_cast<int>(encode_srgb8(tone_map({light, light, light}, ToneMapping::Neutral).x));
  };
  EXPECT_NEAR(code_of(1, key), 247, 3);
  EXPECT_NEAR(code_of(0.8f, key), 243, 3);
  EXPECT_NEAR(code_of(0.8f, {0, 0, 1}), 231, 6);  // as under light from all sides: the colour is that of the material
  EXPECT_NEAR(code_of(0.8f, {0, -1, 0}), 147, 6);
}

TEST(Lighting, TheNeutralCurveReproducesTheBaseColourOfADielectric) {
  // Light of 1 / 0.96 from all sides: below its surface, a dielectric reflects its base colour of it.
  using F = scalar::Float;
  for (const float roughness : {0.0f, 0.2f, 0.3f, 0.4f, 0.5f})
    for (int code = 80; code <= 231; ++code) {
      const float base = decode_srgb(static_cast<float>(code) / 255);
      const auto white = metallic_environment(Vector<F>{base, base, base}, F(0.0f), SpecularFit<F>(roughness).at(1.0f));
      const float light = white.x.v / 0.96f;
      const float3 seen = tone_map({light, light, light}, ToneMapping::Neutral);
      EXPECT_NEAR(encode_srgb8(seen.x), code, 1) << base << " " << roughness;
    }
}

TEST(Lighting, TheStudiosStripsAreBehindWhatTheSideOfABoxMirrors) {
  const PreparedEnvironment studio(studio_cube(32));
  const EnvironmentView view = studio.view({.color = {1, 1, 1}}, {0, 1, 0});
  // The default view sees one side of a box at 62° from its normal, and one from the other side of the box sees the
  // mirror image. A strip there would cover the side's colour by its glare.
  for (const float side : {1.0f, -1.0f}) {
    const float3 normal = normalize({0.87f * side, -0.17f, 0.47f});
    const float3 mirrored = normal * (2 * normal.z) - float3{0, 0, 1};
    const auto light =
        specular_light(view, Vector<scalar::Float>{mirrored.x, mirrored.y, mirrored.z}, scalar::Float(0.3f));
    EXPECT_LT(light.x.v, 0.5f) << side;
  }
}

TEST(Lighting, LeavesAFilesOwnLightAlone) {
  Scene scene;
  scene.lights.resize(1);
  scene.ambient_light = {0.1f, 0.2f, 0.3f};
  light_unlit(scene);
  EXPECT_EQ(scene.environment, Environment{});
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.ambient_light, (float3{0.1f, 0.2f, 0.3f}));
}

// The lights of a file often reach a part of it only.
TEST(Lighting, FillsTheLightOfAFileByADimStudio) {
  Scene scene;
  scene.materials.emplace_back();
  scene.lights.emplace_back();
  EXPECT_EQ(make_lighting(scene).environment, Environment{});
  scene.needs_fill_light = true;
  const Lighting filled = make_lighting(scene);
  EXPECT_EQ(filled.lights.size(), 1u);
  EXPECT_NE(filled.environment.map, nullptr);
  EXPECT_EQ(filled.environment.strength, 0.15f);
  EXPECT_EQ(filled.tone_mapping, ToneMapping::None);
  EXPECT_EQ(make_lighting(scene, {.source = LightSource::Alone}).environment, Environment{});
  const Environment own{.color = {1, 2, 3}};
  EXPECT_EQ(make_lighting(scene, {.environment = own}).environment, own);
  scene.environment = own;
  EXPECT_EQ(make_lighting(scene).environment, own);
}

TEST(Lighting, AnEnvironmentTakesThePlaceOfTheDefaultLights) {
  Scene scene;
  const Lighting lighting = make_lighting(scene, {.environment = Environment{.color = {1, 0.5f, 0}}});
  EXPECT_EQ(lighting.environment.factor(), (float3{1, 0.5f, 0}));
  EXPECT_EQ(lighting.ambient_light, (float3{1, 0.5f, 0}));
  EXPECT_TRUE(lighting.lights.empty());
}

TEST(Lighting, ASceneKeepsItsOwnEnvironment) {
  Scene scene;
  scene.environment = {.color = {1, 2, 3}, .strength = 0.5f};
  light_unlit(scene);
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(scene.ambient_light, (float3{0.5f, 1, 1.5f}));
}

TEST(Lighting, MultipliesEveryLight) {
  Scene scene;
  scene.lights.resize(2);
  scene.lights[1].intensity = 3;
  const Lighting lighting = make_lighting(scene, {.intensity = 2});
  EXPECT_EQ(lighting.lights[0].intensity, 2);
  EXPECT_EQ(lighting.lights[1].intensity, 6);
}

TEST(ConvertMaterial, KeepsTheWidthOfTheHighlightThereAndBack) {
  Material material;
  material.metallic = 0, material.roughness = 0.5f;
  convert_material(material, ShadingModel::BlinnPhong);
  EXPECT_EQ(material.model, ShadingModel::BlinnPhong);
  EXPECT_FLOAT_EQ(material.exponent, 30);  // 2 / 0.5⁴ - 2
  EXPECT_EQ(material.specular, (float3{0.04f, 0.04f, 0.04f}));
  convert_material(material, ShadingModel::MetallicRoughness);
  EXPECT_FLOAT_EQ(material.roughness, 0.5f);
  EXPECT_EQ(material.metallic, 0);
}

TEST(ConvertMaterial, ChangesNothingButTheModelBetweenKin) {
  Material material;
  material.model = ShadingModel::BlinnPhong, material.exponent = 77, material.specular = {1, 2, 3};
  convert_material(material, ShadingModel::Phong);
  EXPECT_EQ(material.exponent, 77);
  EXPECT_EQ(material.specular, (float3{1, 2, 3}));
  convert_material(material, ShadingModel::Unlit);
  EXPECT_EQ(material.model, ShadingModel::Unlit);
}

}  // namespace
}  // namespace zoneplate
