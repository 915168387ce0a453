// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/brightness.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/shade/reflection/brdf.h"
#include "zoneplate/shade/surface/lighting.h"
#include "zoneplate/shade/surface/material_plan.h"
#include "zoneplate/shade/texture/texture.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

float greatest(const float (&color)[3]) { return std::max({color[0], color[1], color[2], 0.0f}); }

/// The greatest irradiance of a light anywhere, perpendicular to its direction; `fading` is at most 1e6.
float arriving(std::span<const PreparedLight> lights) {
  float sum = 0;
  for (const PreparedLight& light : lights)
    sum += greatest(light.radiance) * (light.is_directional ? 1.0f : 1 / min_distance_squared);
  return sum;
}

/// The greatest n·l F V D: V n·l is at most 1 / (2 α) and D at most 1 / (π α²), and F with its specular_gain at most 4,
/// because a lobe reflects more than a quarter of the light.
float highlight(const MaterialPlan& plan) {
  if (plan.model != ShadingModel::MetallicRoughness) return greatest(plan.specular);
  const bool is_textured = plan.slot(TextureSlotIndex::MetallicRoughness).texture != nullptr;
  const float roughness = is_textured ? min_roughness : std::max(plan.roughness, min_roughness);
  const float alpha = roughness * roughness;
  return 4 * inverse_pi / (2 * alpha * alpha * alpha);
}

/// True for a float or half-float texture, whose texels may exceed 1; texels of unorm textures are at most 1.
bool is_unbounded(const TextureSlot& slot) {
  if (slot.texture == nullptr) return false;
  const TextureView& view = slot.texture->view();
  return view.values != nullptr || view.halves != nullptr;
}

/// Diffuse weights, cosines and their powers are at most 1. The highlight of (Blinn-)Phong reflects at most twice the
/// environment; of metallic-roughness, at most the environment.
float brightest(const MaterialPlan& plan, float light, float environment) {
  if (plan.layers != nullptr || plan.attributes.color || is_unbounded(plan.slot(TextureSlotIndex::BaseColor)) ||
      is_unbounded(plan.slot(TextureSlotIndex::Specular)) || is_unbounded(plan.slot(TextureSlotIndex::Emissive)))
    return brightest_color;
  const float base = std::max({plan.factor[0], plan.factor[1], plan.factor[2], 0.0f});
  if (!plan.is_lit) return base;
  const bool is_metallic = plan.model == ShadingModel::MetallicRoughness;
  const float reflected = is_metallic ? environment : 2 * greatest(plan.specular) * environment;
  // Twice the sum: a margin for rounding and for the error of the fit to the environment's integral.
  return 2 * (base * (1 + greatest(plan.ambient_factor) + light + environment) + greatest(plan.own_ambient) +
              highlight(plan) * light + reflected + greatest(plan.emissive_factor));
}

}  // namespace

float brightest_fragment(std::span<const MaterialPlan> plans, std::span<const PreparedLight> lights,
                         float3 environment) {
  const float light = arriving(lights), around = std::max({environment.x, environment.y, environment.z, 0.0f});
  float most = 0;
  for (const MaterialPlan& plan : plans) {
    const float bound = brightest(plan, light, around);
    most = bound < brightest_color ? std::max(most, bound) : brightest_color;
  }
  return most;
}

}  // namespace zoneplate
