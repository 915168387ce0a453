#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "zoneplate/math/vec.h"
#include "zoneplate/scene/alpha_mode.h"
#include "zoneplate/scene/texel_image.h"

namespace zoneplate {

enum class Wrap { Repeat, Mirror, Clamp };

/// The filter between texels of one level, and between levels (None: level 0 only).
enum class TexelFilter { Nearest, Linear };
enum class LevelFilter { None, Nearest, Linear };

struct Sampler {
  Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;
  TexelFilter magnify = TexelFilter::Linear;
  TexelFilter minify = TexelFilter::Linear;
  LevelFilter level = LevelFilter::Linear;
  int anisotropy = 1;  ///< probes along a footprint that is longer than wide, at most 16; for linear filters
  bool operator==(const Sampler&) const = default;
};

/// A decoded image file.
struct TextureImage {
  /// Maximum of texels along a side. Larger images are reduced to a half, a quarter, ... of that side.
  static constexpr int most_side = 32768;

  std::string name;  ///< its file or image, for messages
  TexelImage pixels;
};

/// A use of an image in one slot of a material. `image` < 0: no texture, only the factor.
///
/// The coordinate is (offset + rotation(angle) * (scale * uv)), KHR_texture_transform's order: uv is scaled, then
/// rotated counter-clockwise in a +v-up sense as the extension's matrix says, then moved.
struct TextureUse {
  int image = -1;  ///< index into Scene::images
  Sampler sampler;
  int uv_set = 0;  ///< 0 or 1
  float2 offset{0, 0}, scale{1, 1};
  float rotation = 0;
};

enum class ShadingModel { MetallicRoughness, BlinnPhong, Phong, Unlit };

/// The parameters of a surface. Factors are linear; base colour and emissive images are sRGB-encoded, the others
/// linear.
struct Material {
  std::string name;
  ShadingModel model = ShadingModel::MetallicRoughness;
  AlphaMode alpha_mode = AlphaMode::Opaque;
  float alpha_cutoff = 0.5f;  ///< an alpha-tested surface is present where alpha >= cutoff
  bool double_sided = false;

  float4 base_color{1, 1, 1, 1};  ///< straight alpha; Blinn-Phong's diffuse coefficient
  TextureUse base_color_texture;
  float3 emissive{0, 0, 0};
  TextureUse emissive_texture;
  TextureUse normal_texture;
  float normal_scale = 1;
  TextureUse occlusion_texture;  ///< red channel
  float occlusion_strength = 1;

  float metallic = 1, roughness = 1;      ///< metallic-roughness only
  TextureUse metallic_roughness_texture;  ///< green: roughness, blue: metallic
  float3 ambient{0, 0, 0};                ///< (Blinn-)Phong only: Ka; times the base colour's texture, as Kd is
  float3 specular{0, 0, 0};               ///< (Blinn-)Phong only: Ks
  float exponent = 32;                    ///< (Blinn-)Phong only: Ns
};

/// A texture slot of a material.
struct MaterialTextureSlot {
  std::string_view gltf_name;  ///< the property of a glTF material with this texture
  TextureUse Material::*use;
  bool is_color;               ///< sRGB-encoded, otherwise linear
  bool is_metallic_roughness;  ///< its property is in glTF's pbrMetallicRoughness
};

/// The texture slots of every material, in the order of this list.
inline constexpr std::size_t texture_slot_count = 5;
enum class TextureSlotIndex { BaseColor, MetallicRoughness, Emissive, Normal, Occlusion };
inline constexpr std::array<MaterialTextureSlot, texture_slot_count> material_texture_slots = {
    {{"baseColorTexture", &Material::base_color_texture, true, true},
     {"metallicRoughnessTexture", &Material::metallic_roughness_texture, false, true},
     {"emissiveTexture", &Material::emissive_texture, true, false},
     {"normalTexture", &Material::normal_texture, false, false},
     {"occlusionTexture", &Material::occlusion_texture, false, false}}};

/// The textures of a material, by slot.
inline std::array<const TextureUse*, texture_slot_count> texture_slots(const Material& material) {
  std::array<const TextureUse*, texture_slot_count> uses{};
  for (std::size_t slot = 0; slot < texture_slot_count; ++slot)
    uses[slot] = &(material.*material_texture_slots[slot].use);
  return uses;
}

}  // namespace zoneplate
