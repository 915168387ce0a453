// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "zoneplate/math/vec.h"
#include "zoneplate/scene/alpha_mode.h"
#include "zoneplate/scene/solid_texture.h"
#include "zoneplate/scene/texel_image.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// How a texture continues outside of [0, 1].
enum class Wrap {
  Repeat,  ///< the image repeats
  Mirror,  ///< the image repeats, every second time mirrored
  Clamp,   ///< the texels of the border continue
};

/// How texels of one mip level are combined.
enum class TexelFilter {
  Nearest,  ///< the texel that contains the coordinate
  Linear,   ///< the bilinear mean of the four nearest texels
};
/// How mip levels are combined.
enum class LevelFilter {
  None,     ///< the full image only, which aliases where it is minified
  Nearest,  ///< the level nearest to the level of detail
  Linear,   ///< the weighted mean of the two nearest levels
};

/// How a texture is addressed and filtered.
struct Sampler {
  Wrap wrap_u = Wrap::Repeat, wrap_v = Wrap::Repeat;  ///< along u, along v
  TexelFilter magnify = TexelFilter::Linear;          ///< where a texel is larger than a pixel
  TexelFilter minify = TexelFilter::Linear;           ///< within a mip level, where texels are smaller than pixels
  LevelFilter level = LevelFilter::Linear;            ///< between mip levels, where texels are smaller than pixels
  int anisotropy = 1;  ///< probes along a footprint that is longer than wide, at most 16; for linear filters
  bool operator==(const Sampler&) const = default;
};

/// A decoded image file.
struct TextureImage {
  /// Maximum of texels along a side. Larger images are reduced to a half, a quarter, ... of that side.
  static constexpr int max_side = 32768;

  std::string name{};   ///< its file or image, for messages
  TexelImage pixels{};  ///< in the file's own precision, row 0 at the top
};

/// A use of an image in one slot of a material. `image` < 0: no texture, only the factor.
///
/// The coordinate is (offset + rotation(angle) * (scale * uv)), KHR_texture_transform's order: uv is scaled, then
/// rotated counter-clockwise in a +v-up sense as by the extension's matrix, then translated.
struct TextureUse {
  int image = -1;                    ///< index into Scene::images
  Sampler sampler{};                 ///< the wrap modes and filters of this use
  int uv_set = 0;                    ///< 0 or 1
  float2 offset{0, 0}, scale{1, 1};  ///< in texture coordinates
  float rotation = 0;                ///< radians
};

/// The reflection model of a material.
enum class ShadingModel {
  MetallicRoughness,  ///< glTF 2.0's metallic-roughness BRDF
  BlinnPhong,         ///< a specular lobe about the half vector, as of OBJ's MTL files
  Phong,              ///< a specular lobe about the mirrored direction
  Unlit,              ///< the base colour, without lights
};

struct MaterialLayers;

/// The parameters of a surface. Factors are linear; base colour and emissive images are sRGB-encoded, the others
/// linear.
struct Material {
  std::string name{};                                    ///< need not be unique; Cryptomatte identifies materials by it
  ShadingModel model = ShadingModel::MetallicRoughness;  ///< decides which of the factors below count
  AlphaMode alpha_mode = AlphaMode::Opaque;              ///< what the alpha of the base colour means
  float alpha_cutoff = 0.5f;                             ///< an alpha-tested surface is present where alpha >= cutoff
  bool double_sided = false;                             ///< back faces are drawn too
  bool is_default = false;                               ///< stands for a material that the file does not define

  float4 base_color{1, 1, 1, 1};    ///< straight alpha; Blinn-Phong's diffuse coefficient
  TextureUse base_color_texture{};  ///< multiplies `base_color`
  SolidTexture solid_texture{};     ///< multiplies red, green and blue of `base_color`
  float3 emissive{0, 0, 0};         ///< radiance that the surface emits, unbounded
  TextureUse emissive_texture{};    ///< multiplies `emissive`
  TextureUse normal_texture{};  ///< normals in tangent space: red, green and blue in [0, 1] are x, y and z in [-1, 1]
  float normal_scale = 1;       ///< multiplies x and y of the normal texture
  /// Heights along the normal, in the red channel: their gradient turns the normal of the shading (bump mapping). It
  /// counts where there is no normal texture.
  TextureUse height_texture{};
  float height_scale = 1;  ///< height of the value 1 above the value 0, in world units
  /// The number of steps of parallax occlusion mapping, which moves the coordinates of all textures to where the
  /// viewing ray meets the heights; these lie below the surface. 0: bump mapping only.
  int parallax_layers = 0;
  TextureUse occlusion_texture{};  ///< red channel
  float occlusion_strength = 1;    ///< 0: no occlusion; 1: as the texture has it

  float metallic = 1, roughness = 1;        ///< metallic-roughness only
  TextureUse metallic_roughness_texture{};  ///< green: roughness, blue: metallic
  float3 ambient{0, 0, 0};                  ///< (Blinn-)Phong only: Ka; times the base colour's texture, as Kd is
  float3 specular{0, 0, 0};                 ///< (Blinn-)Phong only: Ks
  TextureUse specular_texture{};            ///< (Blinn-)Phong only: multiplies `specular`
  float exponent = 32;                      ///< (Blinn-)Phong only: Ns
  TextureUse exponent_texture{};            ///< (Blinn-)Phong only: red multiplies `exponent`

  /// Metallic-roughness only: further layers of the surface (scene/material_layers.h), which copies of a material
  /// share; null: none.
  std::shared_ptr<const MaterialLayers> layers{};
};

/// A texture slot of a material.
struct MaterialTextureSlot {
  std::string_view gltf_name{};  ///< the property of a glTF material with this texture; empty: glTF has none
  TextureUse Material::*use;     ///< the member of Material that is the slot
  bool is_color;                 ///< sRGB-encoded, otherwise linear
  bool is_metallic_roughness;    ///< its property is in glTF's pbrMetallicRoughness
};

/// The number of texture slots of a material.
inline constexpr std::size_t texture_slot_count = 8;
/// Indices into `material_texture_slots`.
enum class TextureSlotIndex {
  BaseColor,          ///< Material::base_color_texture
  MetallicRoughness,  ///< Material::metallic_roughness_texture
  Emissive,           ///< Material::emissive_texture
  Normal,             ///< Material::normal_texture
  Occlusion,          ///< Material::occlusion_texture
  Height,             ///< Material::height_texture
  Specular,           ///< Material::specular_texture
  Exponent,           ///< Material::exponent_texture
};
/// The texture slots of every material, by TextureSlotIndex.
inline constexpr std::array<MaterialTextureSlot, texture_slot_count> material_texture_slots = {
    {{"baseColorTexture", &Material::base_color_texture, true, true},
     {"metallicRoughnessTexture", &Material::metallic_roughness_texture, false, true},
     {"emissiveTexture", &Material::emissive_texture, true, false},
     {"normalTexture", &Material::normal_texture, false, false},
     {"occlusionTexture", &Material::occlusion_texture, false, false},
     {"", &Material::height_texture, false, false},
     {"", &Material::specular_texture, true, false},
     {"", &Material::exponent_texture, false, false}}};

}  // namespace zoneplate
#pragma GCC visibility pop
