// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/casters.h"

#include <algorithm>

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

}  // namespace

std::vector<ShadowCaster> make_casters(const Scene& scene) {
  std::vector<ShadowCaster> casters;
  casters.reserve(scene.instances.size());
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = mesh_of(scene, instance);
    ShadowCaster caster;
    if (mesh.topology == Topology::Triangles)
      caster = {mesh.position, mesh.index, instance.world_from_object,
                material_of(scene, mesh).alpha_mode != AlphaMode::Opaque};
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
  float alpha = material.base_color.w;
  if (!mesh.color.empty()) alpha *= mix(mesh.color).w;
  const TextureUse& use = material.base_color_texture;
  if (const Texture* const texture = textures_.find(use, TexelMeaning::Color)) {
    const auto& coordinates = use.uv_set == 0 ? mesh.uv0 : mesh.uv1;
    const float2 uv = coordinates.empty() ? float2{} : mix(coordinates);
    const auto& m = coordinate_map(use).m;
    const float2 mapped{uv.x * m[0] + uv.y * m[1] + m[2], uv.x * m[3] + uv.y * m[4] + m[5]};
    alpha *= sample(*texture, use.sampler, mapped, {}, {}).w;
  }
  if (material.alpha_mode == AlphaMode::Mask) return alpha >= material.alpha_cutoff ? 1.0f : 0.0f;
  return std::clamp(alpha, 0.0f, 1.0f);
}

}  // namespace zoneplate
