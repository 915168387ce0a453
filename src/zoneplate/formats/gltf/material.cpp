// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/material.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/gltf/factors.h"
#include "zoneplate/formats/gltf/layers.h"
#include "zoneplate/formats/import/image_file.h"

namespace zoneplate {
namespace {

/// The used images, numbered in the order of their first use.
struct UsedImages {
  std::vector<std::size_t> source;  ///< index in the file's images
  std::vector<int> number;          ///< for each of the file's images; -1: not used

  int use(std::size_t image) {
    if (number[image] < 0) {
      number[image] = static_cast<int>(source.size());
      source.push_back(image);
    }
    return number[image];
  }
};

Wrap read_wrap(const JsonView& json, const char* key) {
  const std::uint64_t v = json.whole(key, 10497);
  if (v != 10497 && v != 33071 && v != 33648)
    json.fail(std::string(key) + " is " + std::to_string(v) + ", expected 10497, 33071 or 33648");
  return v == 33071 ? Wrap::Clamp : v == 33648 ? Wrap::Mirror : Wrap::Repeat;
}

Sampler read_sampler(const JsonView& json) {
  Sampler s{.wrap_u = read_wrap(json, "wrapS"), .wrap_v = read_wrap(json, "wrapT")};
  const std::uint64_t magnify = json.whole("magFilter", 9729), minify = json.whole("minFilter", 9987);
  if (magnify != 9728 && magnify != 9729)
    json.fail("magFilter is " + std::to_string(magnify) + ", expected 9728 or 9729");
  if (minify != 9728 && minify != 9729 && (minify < 9984 || minify > 9987))
    json.fail("minFilter is " + std::to_string(minify) + ", expected 9728, 9729 or 9984 to 9987");
  // The values are OpenGL's: odd ones are linear within a level, 9986 and 9987 are linear between levels.
  s.magnify = magnify == 9728 ? TexelFilter::Nearest : TexelFilter::Linear;
  s.minify = minify % 2 == 0 ? TexelFilter::Nearest : TexelFilter::Linear;
  s.level = minify < 9984 ? LevelFilter::None : minify < 9986 ? LevelFilter::Nearest : LevelFilter::Linear;
  return s;
}

float2 pair_of(const JsonView& json, const char* key, float2 otherwise) {
  const std::vector<float> v = json.numbers(key, 2);
  return v.empty() ? otherwise : float2{v[0], v[1]};
}

/// Reads KHR_texture_transform of a texture's use; returns the uv set, which it may override.
std::uint64_t read_transform(const JsonView& json, std::uint64_t uv_set, TextureUse& use) {
  const auto transform = json.extension("KHR_texture_transform");
  if (!transform) return uv_set;
  use.offset = pair_of(*transform, "offset", {0, 0});
  use.scale = pair_of(*transform, "scale", {1, 1});
  use.rotation = transform->number("rotation", 0.0f);
  return transform->whole("texCoord", uv_set);
}

class MaterialReader {
 public:
  explicit MaterialReader(GltfFile& file) : file_(file) { images_.number.assign(file.count("images"), -1); }

  Material read(std::size_t i);
  const std::vector<std::size_t>& used_images() const { return images_.source; }

 private:
  TextureUse texture(const JsonView& owner, const std::string& key);
  TextureUse read_texture(const JsonView& owner, const std::string& key);
  void read_textures(const JsonView& owner, bool is_metallic_roughness, Material& m);
  void read_base(const JsonView& json, const char* key, Material& m);
  void read_metallic_roughness(const JsonView& json, Material& m);
  void read_specular_glossiness(const JsonView& json, Material& m);
  void read_alpha(const JsonView& json, Material& m);

  GltfFile& file_;
  UsedImages images_;
};

/// The use of a texture under `key`; without image if there is none, or if it is invalid.
TextureUse MaterialReader::texture(const JsonView& owner, const std::string& key) {
  TextureUse use;
  if (owner.has(key.c_str())) file_.read_optional([&] { use = read_texture(owner, key); });
  return use;
}

TextureUse MaterialReader::read_texture(const JsonView& owner, const std::string& key) {
  TextureUse use;
  const JsonView info = owner.object(key.c_str());
  const std::size_t number = info.index("index", file_.count("textures"));
  const std::uint64_t uv_set = read_transform(info, info.whole("texCoord", 0), use);
  if (uv_set > 1) {
    file_.warn(info.place() + ": uses TEXCOORD_" + std::to_string(uv_set) + ", left out (0 and 1 are supported)");
    return use;
  }
  use.uv_set = static_cast<int>(uv_set);

  const JsonView texture = file_.root().element("textures", number, "texture");
  file_.read_optional([&] {
    if (const auto s = texture.find_index("sampler", file_.count("samplers")))
      use.sampler = read_sampler(file_.root().element("samplers", *s, "sampler"));
  });
  const auto basis = texture.extension("KHR_texture_basisu"), webp = texture.extension("EXT_texture_webp");
  if (const auto source = (basis ? *basis : webp ? *webp : texture).find_index("source", file_.count("images")))
    use.image = images_.use(*source);
  else
    file_.warn(texture.place() + ": has no image that is supported, left out");
  return use;
}

/// Reads the textures that are members of `owner`.
void MaterialReader::read_textures(const JsonView& owner, bool is_metallic_roughness, Material& m) {
  for (const MaterialTextureSlot& slot : material_texture_slots)
    if (slot.is_metallic_roughness == is_metallic_roughness && !slot.gltf_name.empty())
      m.*slot.use = texture(owner, std::string(slot.gltf_name));
}

void MaterialReader::read_base(const JsonView& json, const char* key, Material& m) {
  const std::vector<float> v = read_numbers(file_, json, key, 4);
  if (v.empty()) return;
  const auto channel = [&](float x) { return clamped(file_, json, key, x, 0, 1); };
  m.base_color = {channel(v[0]), channel(v[1]), channel(v[2]), channel(v[3])};
}

void MaterialReader::read_metallic_roughness(const JsonView& json, Material& m) {
  read_base(json, "baseColorFactor", m);
  m.metallic = read_factor(file_, json, "metallicFactor", 1);
  m.roughness = read_factor(file_, json, "roughnessFactor", 1);
  read_textures(json, true, m);
}

/// The parameters that replace the core's; read_layers reads the specular ones.
void MaterialReader::read_specular_glossiness(const JsonView& json, Material& m) {
  m.base_color = {1, 1, 1, 1};
  read_base(json, "diffuseFactor", m);
  m.base_color_texture = texture(json, "diffuseTexture");
  m.metallic_roughness_texture = {};
  m.metallic = 0;
}

void MaterialReader::read_alpha(const JsonView& json, Material& m) {
  file_.read_optional([&] {
    const std::string mode = json.text("alphaMode", "OPAQUE");
    if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND")
      json.fail("alphaMode is " + quoted(mode) + ", expected OPAQUE, MASK or BLEND");
    m.alpha_mode = mode == "MASK" ? AlphaMode::Mask : mode == "BLEND" ? AlphaMode::Blend : AlphaMode::Opaque;
  });
  m.alpha_cutoff = read_factor(file_, json, "alphaCutoff", 0.5f, std::numeric_limits<float>::max());
}

Material MaterialReader::read(std::size_t i) {
  const JsonView json = file_.root().element("materials", i, "material");
  Material m;
  file_.read_optional([&] { m.name = json.text("name"); });
  file_.read_optional([&] { m.double_sided = json.flag("doubleSided", false); });
  read_alpha(json, m);
  file_.read_optional([&] { read_metallic_roughness(json.object("pbrMetallicRoughness"), m); });

  const auto specular_glossiness = json.extension("KHR_materials_pbrSpecularGlossiness");
  if (specular_glossiness) read_specular_glossiness(*specular_glossiness, m);

  m.emissive = read_color_factor(file_, json, "emissiveFactor", {0, 0, 0});
  if (const auto strength = json.extension("KHR_materials_emissive_strength"))
    m.emissive = m.emissive * read_factor(file_, *strength, "emissiveStrength", 1, 1e9f);
  read_textures(json, false, m);
  file_.read_optional([&] { m.normal_scale = json.object("normalTexture").number("scale", 1.0f); });
  file_.read_optional(
      [&] { m.occlusion_strength = read_factor(file_, json.object("occlusionTexture"), "strength", 1); });
  if (json.extension("KHR_materials_unlit"))
    m.model = ShadingModel::Unlit;
  else
    m.layers =
        read_layers(file_, json, [&](const JsonView& owner, const std::string& key) { return texture(owner, key); });
  return m;
}

/// The encoded bytes of an image, and its names.
struct EncodedImage {
  GltfBytes data;
  std::string place, name;
};

EncodedImage read_image(GltfFile& file, std::size_t i) {
  file.budget().check_time();
  const JsonView json = file.root().element("images", i, "image");
  EncodedImage out;
  std::string name = json.text("name");
  if (const auto view = json.find_index("bufferView", file.count("bufferViews"))) {
    out.data.bytes = file.view(*view);
  } else {
    const std::string uri = json.text("uri");
    if (uri.empty()) json.fail("has neither uri nor bufferView");
    out.data = file.load_uri(json, uri);
    if (name.empty() && !uri.starts_with("data:")) name = uri;
  }
  out.place = json.place() + (name.empty() ? "" : " " + zoneplate::quoted(name));
  out.name = name.empty() ? "image " + std::to_string(i) : name;

  // The limits are checked here, one image after the other, so that the result is independent of the threads.
  const auto size = find_image_size(out.data.bytes);
  if (size) {
    const std::uint64_t pixels = static_cast<std::uint64_t>(size->x) * static_cast<std::uint64_t>(size->y);
    if (pixels > file.budget().limits().pixels)
      json.fail("has " + std::to_string(size->x) + " x " + std::to_string(size->y) + " pixels, the limit is " +
                std::to_string(file.budget().limits().pixels) + " (--max-pixels)");
    file.budget().take(decoded_image_memory(out.data.bytes));
  }
  return out;
}

/// Replaces the image indices of a material's textures by `number`; without an image the factor alone counts.
void renumber_images(std::span<const int> number, Material& material) {
  const auto renumber = [&](TextureUse& use) {
    const auto used = static_cast<std::size_t>(use.image);
    if (use.image >= 0) use.image = used < number.size() ? number[used] : -1;
  };
  for (const MaterialTextureSlot& slot : material_texture_slots) renumber(material.*slot.use);
  if (material.layers == nullptr) return;
  auto layers = std::make_shared<MaterialLayers>(*material.layers);
  for (const LayerTextureSlot& slot : layer_texture_slots) renumber((*layers).*slot.use);
  material.layers = std::move(layers);
}

/// Reads all materials without their images: their textures have the indices of used images.
GltfMaterials read_undecoded(GltfFile& file) {
  GltfMaterials out;
  MaterialReader reader(file);
  for (std::size_t i = 0; i < file.count("materials"); ++i) {
    file.budget().take(sizeof(Material));
    out.materials.push_back(reader.read(i));
  }
  out.used_images = reader.used_images();
  return out;
}

}  // namespace

GltfMaterials load_materials(GltfFile& file) {
  GltfMaterials out = read_undecoded(file);
  std::vector<EncodedImage> encoded(out.used_images.size());
  std::vector<std::string> trouble(encoded.size()), flaws(encoded.size());
  for (std::size_t i = 0; i < encoded.size(); ++i) {
    try {
      encoded[i] = read_image(file, out.used_images[i]);
    } catch (const Error& error) {
      file.budget().take(0);  // exceeding the memory budget or the deadline is an error nevertheless
      file.budget().check_time();
      trouble[i] = error.what();
    }
  }
  std::vector<TextureImage> images(encoded.size());
  // Images are decoded in groups of this size, so that the accounting of their memory is independent of the number of
  // threads.
  constexpr std::size_t wave = 16;
  for (std::size_t first = 0; first < encoded.size(); first += wave) {
    const std::size_t count = std::min(wave, encoded.size() - first);
    std::uint64_t working = 0;
    for (std::size_t i = first; i < first + count; ++i) working += image_working_memory(encoded[i].data.bytes);
    file.budget().take(working);
    parallel_for(count, [&](std::size_t i) {
      const EncodedImage& e = encoded[first + i];
      if (!trouble[first + i].empty()) return;
      try {
        DecodedImage decoded = decode_image(e.data.bytes, e.place, file.budget().limits());
        images[first + i] = {e.name, std::move(decoded.texels)};
        flaws[first + i] = std::move(decoded.flaw);
      } catch (const Error& error) {
        trouble[first + i] = error.what();
      }
    });
    file.budget().give_back(working);
    file.budget().check_time();
  }
  out.image_numbers.assign(images.size(), -1);
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (!flaws[i].empty()) file.warn(flaws[i]);
    if (trouble[i].empty()) {
      out.image_numbers[i] = static_cast<int>(out.images.size());
      out.images.push_back(std::move(images[i]));
    } else if (file.budget().limits().is_strict) {
      throw Error(ErrorKind::Input, trouble[i]);
    } else {
      file.warn(trouble[i] + "; drawn without it");
    }
  }
  if (out.images.size() < images.size())
    for (Material& material : out.materials) renumber_images(out.image_numbers, material);
  for (const TextureImage& image : out.images)
    if (const auto warning = size_warning(image)) file.warn(file.budget().file() + ": " + *warning);
  return out;
}

std::vector<Material> read_materials(GltfFile& file, const GltfMaterials& decoded) {
  GltfMaterials out = read_undecoded(file);
  for (Material& material : out.materials) renumber_images(decoded.image_numbers, material);
  return std::move(out.materials);
}

}  // namespace zoneplate
