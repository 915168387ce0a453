// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/cast/casters.h"

#include <algorithm>

#include "zoneplate/shade/surface/layered_plan.h"
#include "zoneplate/shade/surface/material_plan.h"
#include "zoneplate/shade/texture/sample.h"

namespace zoneplate {
namespace {

const Mesh& mesh_of(const Scene& scene, const Instance& instance) {
  return scene.meshes[static_cast<std::size_t>(instance.mesh)];
}
const Material& material_of(const Scene& scene, const Mesh& mesh) {
  return scene.materials[static_cast<std::size_t>(mesh.material)];
}

bool is_translucent(const Material& material) {
  return material.alpha_mode != AlphaMode::Opaque || is_transmissive(material);
}

}  // namespace

std::vector<ShadowCaster> make_casters(const Scene& scene) {
  std::vector<ShadowCaster> casters;
  casters.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = mesh_of(scene, instance);
    ShadowCaster caster;
    if (mesh.topology == Topology::Triangles)
      caster = {mesh.position, mesh.index, instance.world_from_object, is_translucent(material_of(scene, mesh))};
    casters.push_back(caster);
  }
  return casters;
}

float CasterOpacity::at(const RayHit& hit) const {
  const Mesh& mesh = mesh_of(scene_, scene_.instances[hit.instance]);
  const Material& material = material_of(scene_, mesh);
  const auto mix = [&](const auto& values) {
    const std::uint32_t* const v = &mesh.index[std::size_t{3} * hit.primitive];
    return values[v[0]] * (1 - hit.b1 - hit.b2) + values[v[1]] * hit.b1 + values[v[2]] * hit.b2;
  };
  const auto texel = [&](const TextureUse& use, TexelMeaning meaning) -> float4 {
    const Texture* const texture = textures_.find(use, meaning);
    if (texture == nullptr) return {1, 1, 1, 1};
    const auto& coordinates = use.uv_set == 0 ? mesh.uv0 : mesh.uv1;
    const float2 uv = coordinates.empty() ? float2{} : mix(coordinates);
    const auto& m = coordinate_map(use).m;
    const float2 mapped{uv.x * m[0] + uv.y * m[1] + m[2], uv.x * m[3] + uv.y * m[4] + m[5]};
    return sample(*texture, use.sampler, mapped, {}, {});
  };
  float opacity = 1;
  if (material.alpha_mode != AlphaMode::Opaque) {
    float alpha = material.base_color.w * texel(material.base_color_texture, TexelMeaning::Color).w;
    if (!mesh.color.empty()) alpha *= mix(mesh.color).w;
    if (material.alpha_mode == AlphaMode::Blend) opacity = std::clamp(alpha, 0.0f, 1.0f);
    if (material.alpha_mode == AlphaMode::Mask) opacity = alpha >= material.alpha_cutoff ? 1.0f : 0.0f;
  }
  if (is_transmissive(material)) {
    const MaterialLayers& layers = *material.layers;
    const float passing = layers.transmission * texel(layers.transmission_texture, TexelMeaning::Values).x;
    opacity *= std::clamp(1 - passing, 0.0f, 1.0f);
  }
  return opacity;
}

}  // namespace zoneplate
