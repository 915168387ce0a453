// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/layered_plan.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/math/elementary.h"

namespace zoneplate {
namespace {

/// Reflects as an infinite index of refraction does, and keeps arithmetic finite.
constexpr float infinite_ior = 1e6f;

float absorption(float transmitted, float distance) {
  // Light of 1e-6 is as dark as none.
  const float coefficient = -log(std::max(transmitted, 1e-6f)) / distance;
  return std::isfinite(coefficient) ? std::max(coefficient, 0.0f) : 0.0f;
}

}  // namespace

bool has_layers(const Material& material) {
  if (material.layers == nullptr || material.model != ShadingModel::MetallicRoughness) return false;
  const MaterialLayers& m = *material.layers;
  return m.ior != 1.5f || m.specular != 1 || m.specular_texture.image >= 0 || m.specular_color != float3{1, 1, 1} ||
         m.specular_color_texture.image >= 0 || m.glossiness || m.clearcoat > 0 || m.sheen_color != float3{} ||
         m.anisotropy > 0 || m.iridescence > 0 || m.transmission > 0 || m.diffuse_transmission > 0;
}

bool uses_slot(const MaterialLayers& m, LayerSlotIndex slot) {
  switch (slot) {
    case LayerSlotIndex::Specular:
    case LayerSlotIndex::SpecularColor:
      return true;
    case LayerSlotIndex::Clearcoat:
    case LayerSlotIndex::ClearcoatRoughness:
    case LayerSlotIndex::ClearcoatNormal:
      return m.clearcoat > 0;
    case LayerSlotIndex::SheenColor:
    case LayerSlotIndex::SheenRoughness:
      return m.sheen_color != float3{};
    case LayerSlotIndex::Anisotropy:
      return m.anisotropy > 0;
    case LayerSlotIndex::Iridescence:
    case LayerSlotIndex::IridescenceThickness:
      return m.iridescence > 0;
    case LayerSlotIndex::Transmission:
      return m.transmission > 0;
    case LayerSlotIndex::Thickness:
      return m.thickness > 0 && (m.transmission > 0 || m.diffuse_transmission > 0);
    case LayerSlotIndex::DiffuseTransmission:
    case LayerSlotIndex::DiffuseTransmissionColor:
      return m.diffuse_transmission > 0;
  }
  return false;
}

bool is_transmissive(const Material& material) { return has_layers(material) && material.layers->transmission > 0; }

LayeredUniforms make_layered_uniforms(const MaterialLayers& m) {
  LayeredUniforms u;
  u.has_clearcoat = m.clearcoat > 0;
  u.has_sheen = m.sheen_color != float3{};
  u.has_anisotropy = m.anisotropy > 0;
  u.has_iridescence = m.iridescence > 0;
  u.has_transmission = m.transmission > 0;
  u.has_diffuse_transmission = m.diffuse_transmission > 0;
  u.has_volume = m.thickness > 0 && (u.has_transmission || u.has_diffuse_transmission);

  const bool is_infinite = m.ior == 0;
  u.ior = is_infinite ? infinite_ior : std::clamp(m.ior, 1.0f, infinite_ior);
  const float root = (u.ior - 1) / (u.ior + 1);
  u.f0_of_ior = is_infinite ? 1 : root * root;
  u.iridescence_ior = std::clamp(m.iridescence_ior, 1.0f, infinite_ior);
  u.turn[0] = cos(m.anisotropy_rotation), u.turn[1] = sin(m.anisotropy_rotation);

  // A medium of index 1 does not bend light, whatever its roughness.
  u.wall_roughness = std::clamp(2 * u.ior - 2, 0.0f, 1.0f);
  const float colors[3] = {m.attenuation_color.x, m.attenuation_color.y, m.attenuation_color.z};
  for (int c = 0; c < 3; ++c) u.absorption[c] = absorption(colors[c], m.attenuation_distance);
  if (!is_infinite) u.half_spread = std::min((u.ior - 1) * 0.025f * m.dispersion, u.ior - 1);
  return u;
}

void turn_directions(const LayeredUniforms& u, const float* const* texel, int count, LayerState::Array (&stretch)[2]) {
  for (int i = 0; i < count; ++i) {
    float x = 1, y = 0;
    if (texel != nullptr) {
      const float tx = texel[0][i] * 2 - 1, ty = texel[1][i] * 2 - 1, square = tx * tx + ty * ty;
      // A texel without a direction keeps that of the tangent.
      if (square > 1e-12f) x = tx / std::sqrt(square), y = ty / std::sqrt(square);
    }
    stretch[0][i] = x * u.turn[0] - y * u.turn[1];
    stretch[1][i] = x * u.turn[1] + y * u.turn[0];
  }
}

}  // namespace zoneplate
