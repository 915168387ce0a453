#include "zoneplate/scene/mtl_material.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/file.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/scene/gltf_uri.h"
#include "zoneplate/scene/image_file.h"
#include "zoneplate/scene/opacity_map.h"

namespace zoneplate {
namespace {

float linear(float code) { return code <= 1 ? decode_srgb(std::max(0.0f, code)) : code; }
float3 linear(float3 code) { return {linear(code.x), linear(code.y), linear(code.z)}; }

std::string with_slashes(std::string_view name) {
  std::string out(name);
  std::replace(out.begin(), out.end(), '\\', '/');
  if (out.size() >= 2 && out.front() == '"' && out.back() == '"') out = out.substr(1, out.size() - 2);
  return out;
}

/// A file's name as a URI, which is what find_path takes.
std::string to_uri(const std::string& name) {
  std::string out;
  for (const char c : name) out += c == '%' ? std::string("%25") : std::string(1, c);
  return out;
}

bool is_file(const std::string& path) {
  std::error_code trouble;
  return std::filesystem::is_regular_file(path, trouble);
}

TextureUse use_of(const MtlTexture& texture, int image) {
  TextureUse use;
  use.image = image;
  if (texture.clamp) use.sampler.wrap_u = use.sampler.wrap_v = Wrap::Clamp;
  // v_file = offset + scale × (1 - v), and ours is one less that.
  use.scale = texture.scale;
  use.offset = {texture.offset.x, 1 - texture.scale.y - texture.offset.y};
  return use;
}

TextureUse load_texture(const MtlTexture& texture, const std::string& within, ObjFolder& folder) {
  return texture.file.empty() ? TextureUse{} : use_of(texture, folder.image(within, texture.file));
}

/// A factor over an image: one that is missing, or black (as some programs write it), is white.
float3 factor(const std::optional<float3>& color, bool has_image, float3 otherwise, const MtlMaterial& mtl,
              const char* key, ObjFolder& folder) {
  if (!has_image) return color ? linear(*color) : otherwise;
  if (!color) return {1, 1, 1};
  if (*color != float3{0, 0, 0}) return linear(*color);
  folder.warn(
      fmt::format("{}: material {}: {} is black over an image, taken as white", folder.budget().file(), mtl.name, key));
  return {1, 1, 1};
}

/// Puts the opacity map into the base colour image, a new one.
void add_opacity(const MtlMaterial& mtl, const std::string& within, ObjFolder& folder, Material& material) {
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

void warn_of_maps(const MtlMaterial& mtl, ObjFolder& folder) {
  if (mtl.unsupported.empty()) return;
  std::string keys;
  for (const std::string& key : mtl.unsupported) keys += (keys.empty() ? "" : ", ") + key;
  folder.warn(fmt::format("{}: material {}: not drawn: {}", folder.budget().file(), mtl.name, keys));
}

}  // namespace

std::optional<std::string> ObjFolder::find_file(const std::string& within, std::string_view name) const {
  const std::string path = with_slashes(name);
  const bool has_drive = path.size() > 1 && path[1] == ':';
  const bool is_absolute = has_drive || (!path.empty() && path[0] == '/');
  const std::string last = path.substr(path.find_last_of('/') + 1);
  const std::string tries[] = {is_absolute ? path : within + path, path, within + last, last};
  for (const std::string& attempt : tries) {
    const auto found = find_path(folder_, to_uri(attempt), budget_.limits().allowed_paths);
    if (found && is_file(*found)) return found;
  }
  return std::nullopt;
}

FileBytes ObjFolder::open(const std::string& path) const {
  return open_found(folder_, path, budget_.limits().allowed_paths, budget_.limits().memory);
}

int ObjFolder::image(const std::string& within, const std::string& name) {
  constexpr std::size_t most_missing = 1000;
  const auto [known, is_first] = known_.try_emplace({within, name}, -1);
  if (!is_first) return known->second;
  constexpr std::uint64_t of_the_tables = 256;
  budget_.check_time();  // files are looked for
  budget_.take(of_the_tables + 2 * name.size());
  const std::optional<std::string> path = missing_ < most_missing ? find_file(within, name) : std::nullopt;
  const auto [entry, is_new] = images_.try_emplace(path.value_or("missing " + name), -1);
  const bool is_missing = is_new && !path;
  if (is_new && missing_ < most_missing) entry->second = load(name, path);
  if (is_missing && ++missing_ == most_missing) warn(budget_.file() + ": no more textures are looked for");
  return known->second = entry->second;
}

void ObjFolder::warn(std::string text) {
  constexpr std::size_t most_notes = 2000;
  if (++notes_ > most_notes) return;
  budget_.take(text.size());
  scene_.warnings.push_back(notes_ < most_notes ? std::move(text)
                                                : budget_.file() + ": more of this kind is not listed");
}

/// The number of the image that is made, or -1 and a warning.
template <class Make>
int ObjFolder::add(Make make) {
  try {
    scene_.images.push_back(make());
    return static_cast<int>(scene_.images.size()) - 1;
  } catch (const Error& error) {
    // What is over the budget, or late, stays an error.
    budget_.take(0);
    budget_.check_time();
    warn(fmt::format("{}: texture {}", budget_.file(), error.what()));
    return -1;
  }
}

TextureImage ObjFolder::decode(const std::string& name, std::span<const std::uint8_t> bytes) {
  const std::uint64_t working = image_working_memory(bytes);
  budget_.take(name.size() + 2 * sizeof(TextureImage));
  budget_.take(working + decoded_image_memory(bytes));
  TextureImage image{name, decode_image(bytes, name, budget_.limits().pixels)};
  budget_.give_back(working);
  if (const auto warning = size_warning(image)) scene_.warnings.push_back(budget_.file() + ": " + *warning);
  return image;
}

int ObjFolder::load(const std::string& name, const std::optional<std::string>& path) {
  return add([&] {
    if (!path) throw Error(Trouble::Input, name + ": not found in the model's folder");
    const FileBytes file = open(*path);
    return decode(name, file.bytes());
  });
}

void ObjFolder::embed(std::span<const std::string> names, std::span<const std::uint8_t> bytes) {
  const int number = add([&] { return decode(names.front(), bytes); });
  for (const std::string& name : names) images_["missing " + name] = number;
}

void ObjFolder::embed(std::span<const std::string> names, Rgba8Image pixels) {
  const int number = add([&] { return TextureImage{names.front(), std::move(pixels)}; });
  for (const std::string& name : names) images_["missing " + name] = number;
}

Material plain_material(const std::string& name) {
  Material material;
  material.name = name;
  material.model = ShadingModel::BlinnPhong;
  material.double_sided = true;
  material.base_color = {0.8f, 0.8f, 0.8f, 1};
  material.ambient = {0.8f, 0.8f, 0.8f};
  return material;
}

Material make_material(const MtlMaterial& mtl, const std::string& within, ObjFolder& folder) {
  Material m = plain_material(mtl.name);
  m.base_color_texture = load_texture(mtl.diffuse_map, within, folder);
  m.emissive_texture = load_texture(mtl.emissive_map, within, folder);
  m.normal_texture = load_texture(mtl.normal_map, within, folder);
  m.normal_scale = mtl.normal_map.strength;

  const float3 base = factor(mtl.diffuse, m.base_color_texture.image >= 0, {0.8f, 0.8f, 0.8f}, mtl, "Kd", folder);
  const float opacity = mtl.opacity.value_or(1 - mtl.transparency.value_or(0));
  m.base_color = {base.x, base.y, base.z, std::clamp(opacity, 0.0f, 1.0f)};
  if (m.base_color.w < 1) m.alpha_mode = AlphaMode::Blend;
  m.emissive = factor(mtl.emissive, m.emissive_texture.image >= 0, {0, 0, 0}, mtl, "Ke", folder);
  m.ambient = mtl.ambient ? linear(*mtl.ambient) : base;

  const int illumination = mtl.illumination.value_or(2);
  if (illumination > 1) m.specular = linear(mtl.specular.value_or(float3{0, 0, 0}));
  m.exponent = std::clamp(mtl.exponent.value_or(32), 1.0f, 1e5f);
  if (illumination == 0) m.model = ShadingModel::Unlit;
  if (mtl.roughness || mtl.metallic) {
    m.model = ShadingModel::MetallicRoughness;
    m.roughness = std::clamp(mtl.roughness.value_or(1), 0.0f, 1.0f);
    m.metallic = std::clamp(mtl.metallic.value_or(0), 0.0f, 1.0f);
  }
  add_opacity(mtl, within, folder, m);
  warn_of_maps(mtl, folder);
  return m;
}

}  // namespace zoneplate
