// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/surface_constants.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "zoneplate/shade/reflection/brdf.h"
#include "zoneplate/shade/shadow/receivers.h"
#include "zoneplate/shade/surface/layered_plan.h"

namespace zoneplate {
namespace {

Viewpoint make_viewpoint(const ViewUniforms& s) {
  const float3 back = normalize(-s.view_direction, {0, 0, 1});
  Viewpoint v{{s.eye.x, s.eye.y, s.eye.z}, {back.x, back.y, back.z}, s.is_orthographic, s.rays.has_value()};
  if (!s.rays) return v;
  const auto store = [](float3 from, float(&to)[3]) { to[0] = from.x, to[1] = from.y, to[2] = from.z; };
  store(s.rays->first, v.ray), store(s.rays->dx, v.ray_dx), store(s.rays->dy, v.ray_dy);
  return v;
}

std::vector<PreparedLight> prepare_all(const std::vector<Light>& lights) {
  std::vector<PreparedLight> prepared;
  for (const Light& light : lights) prepared.push_back(prepare(light));
  return prepared;
}

bool has_traced_occlusion(const ViewUniforms& view) {
  return view.visibility != nullptr && view.visibility->has_occlusion();
}

void set_layered_roughness(const MaterialPlan& plan, ShadingUniforms& s) {
  const LayeredPlan& layers = *plan.layers;
  const std::optional<float>& glossiness = layers.layers.glossiness;
  const bool has_texture = glossiness ? layers.has(LayerSlotIndex::SpecularColor)
                                      : plan.slot(TextureSlotIndex::MetallicRoughness).texture != nullptr;
  if (!has_texture && !plan.widens()) s.layered_roughness = glossiness ? 1 - *glossiness : plan.roughness;
  if (layers.uniforms.has_clearcoat && !layers.has(LayerSlotIndex::ClearcoatRoughness))
    s.coat_roughness = layers.layers.clearcoat_roughness;
}

/// The constants of a material under the scene's lights; `lights` and `view` must outlive them.
ShadingUniforms make_shading_uniforms(const MaterialPlan& plan, const std::vector<PreparedLight>& lights,
                                      const Viewpoint& viewpoint, const ViewUniforms& view) {
  const auto copy = [](const float(&from)[3], float(&to)[3]) { std::copy_n(from, 3, to); };
  ShadingUniforms s;
  s.light = lights.data(), s.lights = static_cast<int>(lights.size());
  s.viewpoint = viewpoint, s.needs_viewer = plan.needs_viewer;
  s.has_occlusion = plan.slot(TextureSlotIndex::Occlusion).texture != nullptr || has_traced_occlusion(view);
  s.has_emissive_texture = plan.slot(TextureSlotIndex::Emissive).texture != nullptr || plan.has_own_ambient;
  s.has_emissive = plan.has_emissive || plan.has_own_ambient;
  s.has_bare_meshes = plan.has_bare_meshes, s.is_blended = plan.alpha_mode == AlphaMode::Blend;
  copy(plan.emissive_factor, s.emissive);
  s.has_specular = plan.has_specular, s.is_phong = plan.model == ShadingModel::Phong;
  s.has_specular_texture = plan.has_specular && plan.slot(TextureSlotIndex::Specular).texture != nullptr;
  s.has_exponent_texture = plan.has_specular && plan.slot(TextureSlotIndex::Exponent).texture != nullptr;
  copy(plan.ambient_factor, s.ambient), copy(plan.specular, s.specular);
  s.exponent = plan.exponent;
  s.is_metallic = plan.model == ShadingModel::MetallicRoughness;
  s.has_material_texture = plan.slot(TextureSlotIndex::MetallicRoughness).texture != nullptr || plan.widens();
  s.has_turning_normals = plan.has_turning_lobes();
  s.metallic = plan.metallic, s.roughness = plan.roughness;
  if (plan.layers != nullptr) set_layered_roughness(plan, s);
  s.backdrop = view.backdrop ? &*view.backdrop : nullptr;
  s.has_environment_behind = view.has_environment_behind, s.has_background_color = view.background.has_value();
  if (const auto b = view.background) s.background[0] = b->x, s.background[1] = b->y, s.background[2] = b->z;
  s.has_pixels = view.shading_frequency == ShadingFrequency::Fragment;
  const float3 environment = view.environment;
  s.map = view.map ? &*view.map : nullptr;
  s.has_environment = environment.x > 0 || environment.y > 0 || environment.z > 0;
  s.environment[0] = environment.x, s.environment[1] = environment.y, s.environment[2] = environment.z;
  return s;
}

}  // namespace

SurfaceConstants::SurfaceConstants(const Scene& scene_in, const ViewUniforms& view_in, const TextureSet& textures_in,
                                   const InterleavedVertices& records_in)
    : scene(scene_in),
      view(view_in),
      records(records_in),
      plans(make_plans(scene_in, view_in, textures_in)),
      transforms(make_instance_transforms(scene_in.instances)),
      lights(prepare_all(view_in.lights)),
      viewpoint(make_viewpoint(view_in)),
      kernels(SurfaceKernels::of()),
      filtering(FilteringKernels::of()),
      solid(SolidTextureKernels::of()) {
  for (std::size_t m = 0; m < plans.size(); ++m) {
    shading_uniforms.push_back(make_shading_uniforms(plans[m], lights, viewpoint, view));
    needs_of_color.push_back(make_needs(static_cast<int>(m), plans[m].attributes, plans[m].needs_viewer));
    lobes.push_back(make_lobes(plans[m], shading_uniforms.back()));
  }
}

SurfaceConstants::Lobes SurfaceConstants::make_lobes(const MaterialPlan& plan, const ShadingUniforms& s) {
  if (s.map == nullptr || !s.is_metallic) return {};
  const auto mix_of = [&](float roughness) {
    std::unique_ptr<LevelMix>& mix = mixes[roughness];
    if (mix == nullptr) mix = std::make_unique<LevelMix>(*s.map, roughness);
    return mix.get();
  };
  if (plan.layers == nullptr) return {s.has_material_texture ? nullptr : mix_of(s.roughness), nullptr};
  // As light_layered bounds it.
  const auto bounded = [&](float roughness) {
    return roughness >= 0 ? mix_of(std::max(roughness, min_roughness)) : nullptr;
  };
  return {bounded(s.layered_roughness), bounded(s.coat_roughness)};
}

SurfaceConstants::Needs SurfaceConstants::make_needs(int material, Attributes attributes, bool needs_viewer) const {
  if (needs_viewer && !viewpoint.is_orthographic && !viewpoint.has_rays) attributes.position = true;
  Needs needs{attributes, interpolation(records.layout(material), attributes)};
  // Stages before compute_normals, or in its place, read the normals of all fragments.
  const MaterialPlan& plan = plans[static_cast<std::size_t>(material)];
  needs.interpolation.quad[0].has_sparse_normals =
      attributes.normal && !attributes.normal_change && plan.slot(TextureSlotIndex::Normal).texture == nullptr &&
      plan.layers == nullptr && plan.parallax_layers == 0 && view.shading_frequency == ShadingFrequency::Fragment;
  return needs;
}

}  // namespace zoneplate
