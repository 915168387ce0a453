// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "zoneplate/scene/material_layers.h"
#include "zoneplate/shade/surface/layered.h"
#include "zoneplate/shade/surface/material_plan.h"

namespace zoneplate {

/// The decisions that are made once for a material with layers.
struct LayeredPlan {
  MaterialLayers layers;
  std::array<TextureSlot, layer_texture_slot_count> slots;  ///< by LayerSlotIndex
  LayeredUniforms uniforms;

  const TextureSlot& slot(LayerSlotIndex index) const { return slots[static_cast<std::size_t>(index)]; }
  bool has(LayerSlotIndex index) const { return slot(index).texture != nullptr; }
};

/// Whether the layers change the surface of a material.
bool has_layers(const Material& material);

/// Whether the texture of a slot affects the colour of a material that has layers.
bool uses_slot(const MaterialLayers& layers, LayerSlotIndex slot);

/// Whether light of the scene behind a material passes through it.
bool is_transmissive(const Material& material);

/// The constants of a material's layers.
LayeredUniforms make_layered_uniforms(const MaterialLayers& layers);

/// The directions of the texels, from [0, 1] to [-1, 1], turned by the material's rotation; without texels, the
/// rotation itself.
void turn_directions(const LayeredUniforms& uniforms, const float* const* texel, int count,
                     LayerState::Array (&stretch)[2]);

/// Finds the parameters of a plan's layers at `count` fragments. `sample(slot)` looks up a texture and returns its four
/// channels.
///
/// Requires  what the plan has: clearcoat_normal and thickness are left to the caller, but for the texture of the
///           latter.
template <class Kernels, class Sample>
void evaluate_layers(const LayeredPlan& plan, const Kernels& kernels, int count, Sample sample, LayerState& out) {
  using Slot = LayerSlotIndex;
  const MaterialLayers& m = plan.layers;
  const LayeredUniforms& u = plan.uniforms;
  // factor × one channel of a texture.
  const auto number = [&](float factor, Slot slot, int channel, float* to) {
    if (!plan.has(slot)) return kernels.fill(to, factor, count);
    kernels.scale(to, sample(plan.slot(slot))[channel], factor, 0, count);
  };
  const auto color = [&](float3 factor, Slot slot, LayerState::Array(&to)[3]) {
    const float factors[3] = {factor.x, factor.y, factor.z};
    const float* const* const texel = plan.has(slot) ? sample(plan.slot(slot)) : nullptr;
    for (int c = 0; c < 3; ++c) {
      if (texel == nullptr)
        kernels.fill(to[c], factors[c], count);
      else
        kernels.scale(to[c], texel[c], factors[c], 0, count);
    }
  };
  number(m.specular, Slot::Specular, 3, out.specular);
  color(m.specular_color, Slot::SpecularColor, out.specular_color);
  if (u.has_clearcoat) {
    number(m.clearcoat, Slot::Clearcoat, 0, out.clearcoat);
    number(m.clearcoat_roughness, Slot::ClearcoatRoughness, 1, out.clearcoat_roughness);
  }
  if (u.has_sheen) {
    color(m.sheen_color, Slot::SheenColor, out.sheen_color);
    number(m.sheen_roughness, Slot::SheenRoughness, 3, out.sheen_roughness);
  }
  if (u.has_anisotropy) {
    number(m.anisotropy, Slot::Anisotropy, 2, out.anisotropy);
    turn_directions(u, plan.has(Slot::Anisotropy) ? sample(plan.slot(Slot::Anisotropy)) : nullptr, count, out.stretch);
  }
  if (u.has_iridescence) {
    number(m.iridescence, Slot::Iridescence, 0, out.iridescence);
    const float low = m.iridescence_thickness_minimum, high = m.iridescence_thickness_maximum;
    if (plan.has(Slot::IridescenceThickness))
      kernels.scale(out.film_thickness, sample(plan.slot(Slot::IridescenceThickness))[1], high - low, low, count);
    else
      kernels.fill(out.film_thickness, high, count);
  }
  if (u.has_transmission) number(m.transmission, Slot::Transmission, 0, out.transmission);
  if (u.has_volume) number(m.thickness, Slot::Thickness, 1, out.thickness);
  if (u.has_diffuse_transmission) {
    number(m.diffuse_transmission, Slot::DiffuseTransmission, 3, out.diffuse_transmission);
    color(m.diffuse_transmission_color, Slot::DiffuseTransmissionColor, out.diffuse_transmission_color);
  }
}

}  // namespace zoneplate
