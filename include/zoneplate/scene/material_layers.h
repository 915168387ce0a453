// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

#include "zoneplate/math/vec.h"
#include "zoneplate/scene/material.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// Parameters of a metallic-roughness surface beyond glTF's core: its layers, its transmission and its volume. The
/// defaults leave the surface as it is without them.
///
/// Each texture multiplies the factor before it; the channel is given with it. Colours are linear, their images
/// sRGB-encoded.
/// Source    the KHR_materials_* extensions of glTF 2.0, each named at its parameters.
struct MaterialLayers {
  // KHR_materials_ior
  float ior = 1.5f;  ///< index of refraction, at least 1; 0: infinite, as specular-glossiness requires

  // KHR_materials_specular
  float specular = 1;                   ///< strength of the dielectric's specular reflection
  TextureUse specular_texture{};        ///< alpha
  float3 specular_color{1, 1, 1};       ///< multiplies the reflectance at normal incidence; may exceed 1
  TextureUse specular_color_texture{};  ///< colour
  /// Given: the roughness is 1 - glossiness × alpha of the specular colour's texture, and Material::roughness is unused
  /// (KHR_materials_pbrSpecularGlossiness, whose other parameters are the base colour, the specular colour and ior 0).
  std::optional<float> glossiness{};

  // KHR_materials_clearcoat
  float clearcoat = 0;                       ///< strength of the coating
  TextureUse clearcoat_texture{};            ///< red
  float clearcoat_roughness = 0;             ///< of the coating alone
  TextureUse clearcoat_roughness_texture{};  ///< green
  TextureUse clearcoat_normal_texture{};     ///< of the coating alone, like Material::normal_texture
  float clearcoat_normal_scale = 1;          ///< multiplies x and y of that texture

  // KHR_materials_sheen
  float3 sheen_color{0, 0, 0};           ///< reflectance of the fibres
  TextureUse sheen_color_texture{};      ///< colour
  float sheen_roughness = 0;             ///< of the fibres alone
  TextureUse sheen_roughness_texture{};  ///< alpha

  // KHR_materials_anisotropy
  float anisotropy = 0;           ///< 0: round highlights; 1: stretched along the direction
  float anisotropy_rotation = 0;  ///< of the direction, counter-clockwise from the tangent; radians
  TextureUse
      anisotropy_texture;  ///< red and green: the direction, from [0, 1] to [-1, 1]; blue: multiplies the strength

  // KHR_materials_iridescence
  float iridescence = 0;                       ///< strength of the thin film
  TextureUse iridescence_texture{};            ///< red
  float iridescence_ior = 1.3f;                ///< of the film, at least 1
  float iridescence_thickness_minimum = 100;   ///< nanometres, where the texture is 0
  float iridescence_thickness_maximum = 400;   ///< nanometres, where the texture is 1 or absent
  TextureUse iridescence_thickness_texture{};  ///< green

  // KHR_materials_transmission
  float transmission = 0;             ///< share of the light entering the surface that passes through it
  TextureUse transmission_texture{};  ///< red

  // KHR_materials_volume
  float thickness = 0;             ///< of the volume below the surface, in the mesh's space; 0: a thin wall
  TextureUse thickness_texture{};  ///< green
  float attenuation_distance = std::numeric_limits<float>::infinity();  ///< in world space, above 0
  float3 attenuation_color{1, 1, 1};                                    ///< what white light becomes over that distance

  // KHR_materials_dispersion
  float dispersion = 0;  ///< 20 / Abbe number

  // KHR_materials_diffuse_transmission
  float diffuse_transmission = 0;                   ///< share of the diffuse light that leaves on the other side
  TextureUse diffuse_transmission_texture{};        ///< alpha
  float3 diffuse_transmission_color{1, 1, 1};       ///< multiplies that light
  TextureUse diffuse_transmission_color_texture{};  ///< colour
};

/// A texture slot of a material's layers.
struct LayerTextureSlot {
  std::string_view extension{};     ///< the glTF extension with this texture
  std::string_view gltf_name{};     ///< the property of the extension
  TextureUse MaterialLayers::*use;  ///< the member of MaterialLayers that is the slot
  bool is_color;                    ///< sRGB-encoded, otherwise linear
};

/// The number of texture slots of a material's layers.
inline constexpr std::size_t layer_texture_slot_count = 14;
/// Indices into `layer_texture_slots`.
enum class LayerSlotIndex {
  Specular,                  ///< MaterialLayers::specular_texture
  SpecularColor,             ///< MaterialLayers::specular_color_texture
  Clearcoat,                 ///< MaterialLayers::clearcoat_texture
  ClearcoatRoughness,        ///< MaterialLayers::clearcoat_roughness_texture
  ClearcoatNormal,           ///< MaterialLayers::clearcoat_normal_texture
  SheenColor,                ///< MaterialLayers::sheen_color_texture
  SheenRoughness,            ///< MaterialLayers::sheen_roughness_texture
  Anisotropy,                ///< MaterialLayers::anisotropy_texture
  Iridescence,               ///< MaterialLayers::iridescence_texture
  IridescenceThickness,      ///< MaterialLayers::iridescence_thickness_texture
  Transmission,              ///< MaterialLayers::transmission_texture
  Thickness,                 ///< MaterialLayers::thickness_texture
  DiffuseTransmission,       ///< MaterialLayers::diffuse_transmission_texture
  DiffuseTransmissionColor,  ///< MaterialLayers::diffuse_transmission_color_texture
};
/// The texture slots of every material's layers, by LayerSlotIndex.
inline constexpr std::array<LayerTextureSlot, layer_texture_slot_count> layer_texture_slots = {{
    {"KHR_materials_specular", "specularTexture", &MaterialLayers::specular_texture, false},
    {"KHR_materials_specular", "specularColorTexture", &MaterialLayers::specular_color_texture, true},
    {"KHR_materials_clearcoat", "clearcoatTexture", &MaterialLayers::clearcoat_texture, false},
    {"KHR_materials_clearcoat", "clearcoatRoughnessTexture", &MaterialLayers::clearcoat_roughness_texture, false},
    {"KHR_materials_clearcoat", "clearcoatNormalTexture", &MaterialLayers::clearcoat_normal_texture, false},
    {"KHR_materials_sheen", "sheenColorTexture", &MaterialLayers::sheen_color_texture, true},
    {"KHR_materials_sheen", "sheenRoughnessTexture", &MaterialLayers::sheen_roughness_texture, false},
    {"KHR_materials_anisotropy", "anisotropyTexture", &MaterialLayers::anisotropy_texture, false},
    {"KHR_materials_iridescence", "iridescenceTexture", &MaterialLayers::iridescence_texture, false},
    {"KHR_materials_iridescence", "iridescenceThicknessTexture", &MaterialLayers::iridescence_thickness_texture, false},
    {"KHR_materials_transmission", "transmissionTexture", &MaterialLayers::transmission_texture, false},
    {"KHR_materials_volume", "thicknessTexture", &MaterialLayers::thickness_texture, false},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionTexture", &MaterialLayers::diffuse_transmission_texture,
     false},
    {"KHR_materials_diffuse_transmission", "diffuseTransmissionColorTexture",
     &MaterialLayers::diffuse_transmission_color_texture, true},
}};

/// Calls use(texture use) for every texture slot of a material, with those of its layers.
template <class Use>
void for_texture_uses(const Material& material, Use use) {
  for (const MaterialTextureSlot& slot : material_texture_slots) use(material.*slot.use);
  if (material.layers == nullptr) return;
  for (const LayerTextureSlot& slot : layer_texture_slots) use((*material.layers).*slot.use);
}

/// Whether tangents enter the shading of a material: it has a normal map, of the surface or of its coating, or
/// stretched highlights.
inline bool needs_tangents(const Material& material) {
  if (material.normal_texture.image >= 0) return true;
  const MaterialLayers* const l = material.layers.get();
  return l != nullptr && (l->clearcoat_normal_texture.image >= 0 || l->anisotropy > 0);
}

/// The texture coordinates along which the tangents of a material run where its meshes have none.
inline int tangent_uv_set(const Material& material) {
  if (material.normal_texture.image >= 0 || material.layers == nullptr) return material.normal_texture.uv_set;
  const MaterialLayers& l = *material.layers;
  return l.clearcoat_normal_texture.image >= 0 ? l.clearcoat_normal_texture.uv_set : l.anisotropy_texture.uv_set;
}

}  // namespace zoneplate
#pragma GCC visibility pop
