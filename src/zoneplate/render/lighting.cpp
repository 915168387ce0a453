// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/lighting.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "zoneplate/scene/default_lights.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/environment/studio.h"

namespace zoneplate {
namespace {

bool is_phong(ShadingModel model) { return model == ShadingModel::BlinnPhong || model == ShadingModel::Phong; }

/// The ambient light that stands for an environment: that of one colour. The light of an image depends on the normal.
float3 ambient_of(const Environment& environment) {
  return environment.image < 0 && !environment.map ? environment.factor() : float3{0, 0, 0};
}

/// True if a material reflects its environment.
bool is_mirroring(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.model == ShadingModel::MetallicRoughness; });
}

/// The default light of scenes whose materials do not reflect an environment.
Lighting three_lights(const Scene& scene) {
  Lighting lighting{default_lights(), {.color = {default_environment, default_environment, default_environment}}, {}};
  // (Blinn-)Phong's diffuse term lacks the factor 1 / π: dividing the lights by π gives a white surface the same
  // brightness in every model.
  constexpr float pi = 3.14159265f;
  const auto is_made_of_it = [](const Material& m) { return is_phong(m.model); };
  if (!scene.materials.empty() && std::all_of(scene.materials.begin(), scene.materials.end(), is_made_of_it))
    for (Light& light : lighting.lights) light.intensity /= pi;
  // Surfaces without a material, as in STL files, are all white: more of their light comes from the key light, whose
  // shading alone shows their form.
  constexpr float plain_key = 1.2f, plain_environment = 0.14f;
  if (!scene.materials.empty() && std::ranges::all_of(scene.materials, &Material::is_default)) {
    lighting.lights.front().intensity *= plain_key;
    lighting.environment.color = {plain_environment, plain_environment, plain_environment};
  }
  return lighting;
}

/// The studio, and a directional light from its brightest box, which gives the form and casts the shadow that the
/// filtered environment cannot cast.
Lighting studio_lighting(const LightingOptions& options) {
  Light key;
  key.name = "key";
  key.is_in_camera_space = true;
  key.direction = -studio_key();
  key.intensity = studio_key_lux;
  key.radius = studio_key_radius;
  return {{key},
          {.color = {1, 1, 1},
           .is_in_camera_space = true,
           .strength = options.intensity,
           .map = options.studio ? options.studio() : shared_studio()},
          {},
          ToneMapping::Neutral};
}

/// The fill light of a scene, as a part of the default light's environment: what the scene's lights do not reach can be
/// recognised, and a light of a few lux dominates where it reaches. Chosen by looking at 0.3, which washes out coloured
/// lights, and at 0.15.
constexpr float fill = 0.15f;

}  // namespace

void convert_material(Material& material, ShadingModel model) {
  // A Blinn-Phong lobe of exponent 2 / r⁴ - 2 is as wide as a GGX lobe of roughness r.
  // Source: Karis, Specular BRDF Reference, 2013 (alpha = r², exponent = 2 / alpha² - 2).
  if (is_phong(model) && !is_phong(material.model)) {
    const float alpha = std::max(0.05f, material.roughness * material.roughness);
    // With a metalness texture the factor alone does not describe the surface, which then counts as a dielectric.
    const float metallic = material.metallic_roughness_texture.image < 0 ? material.metallic : 0;
    const float dielectric = 0.04f * (1 - metallic);
    const float3 color = xyz(material.base_color);
    material.ambient = color;
    material.specular = color * metallic + float3{dielectric, dielectric, dielectric};
    material.exponent = std::max(1.0f, 2 / (alpha * alpha) - 2);
  }
  if (model == ShadingModel::MetallicRoughness && is_phong(material.model)) {
    material.metallic = 0;
    material.roughness = std::sqrt(std::sqrt(2 / (material.exponent + 2)));
  }
  material.model = model;
}

Lighting make_lighting(const Scene& scene, const LightingOptions& options) {
  Lighting lighting;
  if (options.source != LightSource::Default) lighting = {scene.lights, scene.environment, scene.ambient_light};
  const bool is_unlit = lighting.lights.empty() && lighting.environment == Environment{};
  if (options.environment) {
    lighting.environment = *options.environment;
  } else if (is_unlit || options.source == LightSource::Both) {
    Lighting added = is_mirroring(scene) ? studio_lighting(options) : three_lights(scene);
    if (is_unlit) {
      lighting = std::move(added);
    } else {
      lighting.lights.insert(lighting.lights.end(), added.lights.begin(), added.lights.end());
      if (lighting.environment == Environment{}) lighting.environment = std::move(added.environment);
    }
  } else if (scene.needs_fill_light && options.source == LightSource::Scene && lighting.environment == Environment{}) {
    lighting.environment = (is_mirroring(scene) ? studio_lighting(options) : three_lights(scene)).environment;
    lighting.environment.strength *= fill;
  }
  for (Light& light : lighting.lights) light.intensity *= options.intensity;
  if (lighting.ambient_light == float3{}) lighting.ambient_light = ambient_of(lighting.environment);
  return lighting;
}

void light_unlit(Scene& scene, const LightingOptions& options) {
  Lighting lighting = make_lighting(scene, options);
  scene.lights = std::move(lighting.lights);
  scene.environment = lighting.environment;
  scene.ambient_light = lighting.ambient_light;
}

}  // namespace zoneplate
