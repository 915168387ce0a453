#include "zoneplate/cli/look.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/scene/default_lights.h"

namespace zoneplate::cli {
namespace {

bool is_phong(ShadingModel model) { return model == ShadingModel::BlinnPhong || model == ShadingModel::Phong; }

}  // namespace

void change_model(Material& material, ShadingModel model) {
  // A Blinn-Phong lobe of exponent 2 / r⁴ - 2 is as wide as a GGX lobe of roughness r.
  // Source: Karis, Specular BRDF Reference, 2013 (alpha = r², exponent = 2 / alpha² - 2).
  if (is_phong(model) && !is_phong(material.model)) {
    const float alpha = std::max(0.05f, material.roughness * material.roughness);
    const float share = material.metallic, dielectric = 0.04f * (1 - share);
    const float3 color = xyz(material.base_color);
    material.ambient = color;
    material.specular = color * share + float3{dielectric, dielectric, dielectric};
    material.exponent = std::max(1.0f, 2 / (alpha * alpha) - 2);
  }
  if (model == ShadingModel::MetallicRoughness && is_phong(material.model)) {
    material.metallic = 0;
    material.roughness = std::sqrt(std::sqrt(2 / (material.exponent + 2)));
  }
  material.model = model;
}

float3 apply_look(Scene& scene, const Camera& camera, const Look& look) {
  if (look.shading_model)
    for (Material& material : scene.materials) change_model(material, *look.shading_model);

  float3 environment = look.environment.value_or(float3{0, 0, 0});
  if (scene.lights.empty() && !look.environment) {
    scene.lights = default_lights(camera);
    environment = {default_environment, default_environment, default_environment};
  }
  for (Light& light : scene.lights) light.intensity *= look.light_intensity;
  if (scene.ambient_light == float3{}) scene.ambient_light = environment;
  return environment;
}

}  // namespace zoneplate::cli
