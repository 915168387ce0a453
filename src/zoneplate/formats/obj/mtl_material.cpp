// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/mtl_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/import/model_path.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/channel_image.h"
#include "zoneplate/scene/material_layers.h"
#include "zoneplate/scene/opacity_map.h"

namespace zoneplate {
namespace {

float linear(float code) { return code <= 1 ? decode_srgb(std::max(0.0f, code)) : code; }
float3 linear(float3 code) { return {linear(code.x), linear(code.y), linear(code.z)}; }

TextureUse use_of(const MtlTexture& texture, int image) {
  TextureUse use;
  use.image = image;
  if (texture.clamp) use.sampler.wrap_u = use.sampler.wrap_v = Wrap::Clamp;
  // uv_file = offset + rotation × scale × (u, 1 - v), and our v is 1 - v_file.
  const float c = cos(texture.rotation), s = sin(texture.rotation);
  use.scale = texture.scale;
  use.rotation = texture.rotation;
  use.offset = {texture.offset.x - s * texture.scale.y, 1 - c * texture.scale.y - texture.offset.y};
  use.uv_set = texture.uv_set;
  return use;
}

TextureUse load_texture(const MtlTexture& texture, const std::string& within, ModelFolder& folder) {
  return texture.file.empty() ? TextureUse{} : use_of(texture, folder.image(within, texture.file));
}

/// The factor of an image: white if the file has none, or black, which some programs write.
float3 factor(const std::optional<float3>& color, bool has_image, float3 otherwise, const MtlMaterial& mtl,
              const char* key, ModelFolder& folder) {
  if (!has_image) return color ? linear(*color) : otherwise;
  if (!color) return {1, 1, 1};
  if (*color != float3{0, 0, 0}) return linear(*color);
  folder.warn(
      fmt::format("{}: material {}: {} is black over an image, taken as white", folder.budget().file(), mtl.name, key));
  return {1, 1, 1};
}

/// The alpha of a material. One that would hide all of its surfaces is opaque, with a warning: programs that mean
/// opaque write Tr 1 (3ds Max, MeshLab) or d 0.
float opacity_of(const MtlMaterial& mtl, ModelFolder& folder) {
  const float opacity = std::clamp(mtl.opacity.value_or(1 - mtl.transparency.value_or(0)), 0.0f, 1.0f);
  if (opacity > 0) return opacity;
  folder.warn(fmt::format("{}: material {}: {} would hide its surfaces, taken as opaque", folder.budget().file(),
                          mtl.name, mtl.opacity ? "opacity 0" : "Tr 1"));
  return 1;
}

/// Adds the opacity map as alpha to a copy of the base colour image.
void add_opacity(const MtlMaterial& mtl, const std::string& within, ModelFolder& folder, Material& material) {
  if (mtl.opacity_map.file.empty()) return;
  const int map = folder.image(within, mtl.opacity_map.file);
  if (map < 0) return;
  std::vector<TextureImage>& images = folder.scene().images;
  TextureUse& base = material.base_color_texture;
  const TexelImage* color = base.image >= 0 ? &images[static_cast<std::size_t>(base.image)].pixels : nullptr;
  const TextureImage& mask = images[static_cast<std::size_t>(map)];
  folder.budget().take(with_opacity_memory(color, mask.pixels));
  TextureImage both{mask.name, with_opacity(color, mask.pixels)};
  if (is_opaque(both.pixels)) return;
  if (color == nullptr) base = use_of(mtl.opacity_map, 0);
  base.image = static_cast<int>(images.size());
  images.push_back(std::move(both));
  material.alpha_mode = AlphaMode::Blend;
}

/// Joins the maps of roughness and metalness in one image, a new one.
void add_metallic_roughness(const MtlMaterial& mtl, const std::string& within, ModelFolder& folder, Material& m) {
  const auto find = [&](const MtlTexture& texture) {
    return texture.file.empty() ? -1 : folder.image(within, texture.file);
  };
  const int roughness = find(mtl.roughness_map), metallic = find(mtl.metallic_map);
  if (roughness < 0 && metallic < 0) return;
  std::vector<TextureImage>& images = folder.scene().images;
  const auto pixels = [&](int i) { return i < 0 ? nullptr : &images[static_cast<std::size_t>(i)].pixels; };
  folder.budget().take(with_metallic_roughness_memory(pixels(roughness), pixels(metallic)));
  TextureImage both{images[static_cast<std::size_t>(std::max(roughness, metallic))].name,
                    with_metallic_roughness(pixels(roughness), pixels(metallic))};
  m.metallic_roughness_texture =
      use_of(roughness >= 0 ? mtl.roughness_map : mtl.metallic_map, static_cast<int>(images.size()));
  images.push_back(std::move(both));
}

float3 color_of(Rgba8 p) { return float3{float(p.r), float(p.g), float(p.b)} * (1.0f / 255); }
float3 color_of(Rgba16 p) { return float3{float(p.r), float(p.g), float(p.b)} * (1.0f / 65535); }
float3 color_of(float4 p) { return xyz(p); }

/// Whether an image holds unit vectors, as normal maps do: three quarters of its texels, and these are not grey.
bool holds_normals(const TexelImage& image) {
  constexpr float tolerance = 0.15f;  // of the length: filtered and compressed normals are not exactly of unit length
  return image.visit([](const auto& plane) {
    std::size_t units = 0;
    for (const auto& texel : plane.values()) {
      const float3 color = color_of(texel), n = color * 2 - float3{1, 1, 1};
      const bool is_grey = color.x == color.z && color.y == color.z;
      if (!is_grey && n.z > 0 && std::abs(length(n) - 1) < tolerance) ++units;
    }
    return units * 4 > plane.values().size() * 3;
  });
}

/// A bump map is a texture of heights, or, as several programs write it, one of normals. A displacement map counts
/// where there is no bump map.
void add_bumps(const MtlMaterial& mtl, const std::string& within, ModelFolder& folder, Material& m) {
  const MtlTexture& map = mtl.bump_map.file.empty() ? mtl.displacement_map : mtl.bump_map;
  const TextureUse use = load_texture(map, within, folder);
  if (use.image < 0) return;
  const bool has_normals = holds_normals(folder.scene().images[static_cast<std::size_t>(use.image)].pixels);
  if (has_normals && m.normal_texture.image < 0)
    m.normal_texture = use, m.normal_scale = map.strength;
  else if (!has_normals)
    m.height_texture = use, m.height_scale = map.strength;
}

void warn_of_maps(const MtlMaterial& mtl, ModelFolder& folder) {
  if (mtl.unsupported.empty()) return;
  std::string keys;
  for (const std::string& key : mtl.unsupported) keys += (keys.empty() ? "" : ", ") + key;
  folder.warn(fmt::format("{}: material {}: not drawn: {}", folder.budget().file(), mtl.name, keys));
}

/// The layers of a metallic-roughness material, with the index of refraction of its dielectric part.
void add_layers(const MtlMaterial& mtl, Material& m) {
  const auto share = [](const std::optional<float>& value) { return std::clamp(value.value_or(0), 0.0f, 1.0f); };
  constexpr float full_turn = 6.2831853f;
  constexpr float sheen_roughness = 0.5f;  // MTL has no key for it
  MaterialLayers layers;
  layers.ior = std::clamp(mtl.index_of_refraction.value_or(1.5f), 1.0f, 10.0f);
  layers.sheen_color = float3{1, 1, 1} * share(mtl.sheen);
  layers.sheen_roughness = sheen_roughness;
  layers.clearcoat = share(mtl.clearcoat);
  layers.clearcoat_roughness = share(mtl.clearcoat_roughness);
  layers.anisotropy = share(mtl.anisotropy);
  layers.anisotropy_rotation = std::clamp(mtl.anisotropy_rotation.value_or(0), -1.0f, 1.0f) * full_turn;
  if (layers.ior != 1.5f || mtl.sheen || mtl.clearcoat || mtl.anisotropy)
    m.layers = std::make_shared<const MaterialLayers>(layers);
}

}  // namespace

Material make_material(const MtlMaterial& mtl, const std::string& within, ModelFolder& folder) {
  Material m = plain_material(mtl.name);
  m.is_default = false;
  m.base_color_texture = load_texture(mtl.diffuse_map, within, folder);
  m.emissive_texture = load_texture(mtl.emissive_map, within, folder);
  m.normal_texture = load_texture(mtl.normal_map, within, folder);
  m.normal_scale = mtl.normal_map.strength;
  add_bumps(mtl, within, folder, m);

  const float3 base = factor(mtl.diffuse, m.base_color_texture.image >= 0, {0.8f, 0.8f, 0.8f}, mtl, "Kd", folder);
  m.base_color = {base.x, base.y, base.z, opacity_of(mtl, folder)};
  if (m.base_color.w < 1) m.alpha_mode = AlphaMode::Blend;
  m.emissive = factor(mtl.emissive, m.emissive_texture.image >= 0, {0, 0, 0}, mtl, "Ke", folder);
  m.ambient = mtl.ambient ? linear(*mtl.ambient) : base;

  // Programs without highlights write illum 2 and Ks 1 with an exponent of 0 (MeshLab), or with none.
  const int illumination = mtl.illumination.value_or(2);
  const bool has_exponent = mtl.exponent.value_or(0) > 0 || !mtl.exponent_map.file.empty();
  if (illumination > 1 && has_exponent) {
    m.specular_texture = load_texture(mtl.specular_map, within, folder);
    m.specular = factor(mtl.specular, m.specular_texture.image >= 0, {0, 0, 0}, mtl, "Ks", folder);
    m.exponent_texture = load_texture(mtl.exponent_map, within, folder);
  }
  m.exponent = std::clamp(mtl.exponent.value_or(32), 1.0f, 1e5f);
  if (illumination == 0) m.model = ShadingModel::Unlit;
  const bool has_roughness_map = !mtl.roughness_map.file.empty(), has_metallic_map = !mtl.metallic_map.file.empty();
  if (mtl.roughness || mtl.metallic || has_roughness_map || has_metallic_map) {
    m.model = ShadingModel::MetallicRoughness;
    m.roughness = std::clamp(mtl.roughness.value_or(1), 0.0f, 1.0f);
    m.metallic = std::clamp(mtl.metallic.value_or(has_metallic_map ? 1.0f : 0.0f), 0.0f, 1.0f);
    add_metallic_roughness(mtl, within, folder, m);
    add_layers(mtl, m);
  }
  add_opacity(mtl, within, folder, m);
  warn_of_maps(mtl, folder);
  return m;
}

}  // namespace zoneplate
