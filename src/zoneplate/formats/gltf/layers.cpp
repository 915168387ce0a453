// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/layers.h"

#include <limits>
#include <optional>

#include "zoneplate/formats/gltf/factors.h"

namespace zoneplate {
namespace {

/// The upper bound of factors that the specification leaves unbounded.
constexpr float unbounded = 1e9f;

/// The layers of one material; each function reads the extension of its name.
class LayerReader {
 public:
  LayerReader(GltfFile& file, const JsonView& material, const TextureReader& texture)
      : file_(file), material_(material), texture_(texture) {}

  std::shared_ptr<const MaterialLayers> read() {
    read("KHR_materials_ior", [this](const JsonView& e) { read_ior(e); });
    read("KHR_materials_specular", [this](const JsonView& e) { read_specular(e); });
    read("KHR_materials_clearcoat", [this](const JsonView& e) { read_clearcoat(e); });
    read("KHR_materials_sheen", [this](const JsonView& e) { read_sheen(e); });
    read("KHR_materials_anisotropy", [this](const JsonView& e) { read_anisotropy(e); });
    read("KHR_materials_iridescence", [this](const JsonView& e) { read_iridescence(e); });
    read("KHR_materials_transmission",
         [this](const JsonView& e) { layers_.transmission = read_factor(file_, e, "transmissionFactor", 0); });
    read("KHR_materials_volume", [this](const JsonView& e) { read_volume(e); });
    read("KHR_materials_dispersion",
         [this](const JsonView& e) { layers_.dispersion = read_factor(file_, e, "dispersion", 0, unbounded); });
    read("KHR_materials_diffuse_transmission", [this](const JsonView& e) { read_diffuse_transmission(e); });
    read("KHR_materials_pbrSpecularGlossiness", [this](const JsonView& e) { read_glossiness(e); });
    if (!has_any_) return nullptr;
    for (const LayerTextureSlot& slot : layer_texture_slots)
      if (const auto e = material_.extension(slot.extension.data()); e && e->has(slot.gltf_name.data()))
        layers_.*slot.use = texture_(*e, std::string(slot.gltf_name));
    file_.budget().take(sizeof(MaterialLayers));
    return std::make_shared<const MaterialLayers>(layers_);
  }

 private:
  /// Reads an extension, if the material has it; what of it is invalid keeps its default.
  template <class Read>
  void read(const char* extension, const Read& read_extension) {
    file_.read_optional([&] {
      const std::optional<JsonView> found = material_.extension(extension);
      if (!found) return;
      has_any_ = true;
      read_extension(*found);
    });
  }

  /// An index of refraction, at least 1.
  float index_of_refraction(const JsonView& json, const char* key, float otherwise) {
    return clamped(file_, json, key, json.number(key, otherwise), 1, unbounded);
  }

  void read_ior(const JsonView& json) {
    const bool is_infinite = json.has("ior") && json.number("ior") == 0;
    layers_.ior = is_infinite ? 0 : index_of_refraction(json, "ior", 1.5f);
  }
  void read_specular(const JsonView& json) {
    layers_.specular = read_factor(file_, json, "specularFactor", 1);
    layers_.specular_color = read_color_factor(file_, json, "specularColorFactor", {1, 1, 1}, unbounded);
  }
  void read_clearcoat(const JsonView& json) {
    layers_.clearcoat = read_factor(file_, json, "clearcoatFactor", 0);
    layers_.clearcoat_roughness = read_factor(file_, json, "clearcoatRoughnessFactor", 0);
    layers_.clearcoat_normal_scale = json.object("clearcoatNormalTexture").number("scale", 1.0f);
  }
  void read_sheen(const JsonView& json) {
    layers_.sheen_color = read_color_factor(file_, json, "sheenColorFactor", {0, 0, 0});
    layers_.sheen_roughness = read_factor(file_, json, "sheenRoughnessFactor", 0);
  }
  void read_anisotropy(const JsonView& json) {
    layers_.anisotropy = read_factor(file_, json, "anisotropyStrength", 0);
    layers_.anisotropy_rotation = json.number("anisotropyRotation", 0.0f);
  }
  void read_iridescence(const JsonView& json) {
    layers_.iridescence = read_factor(file_, json, "iridescenceFactor", 0);
    layers_.iridescence_ior = index_of_refraction(json, "iridescenceIor", 1.3f);
    layers_.iridescence_thickness_minimum = read_factor(file_, json, "iridescenceThicknessMinimum", 100, unbounded);
    layers_.iridescence_thickness_maximum = read_factor(file_, json, "iridescenceThicknessMaximum", 400, unbounded);
  }
  void read_volume(const JsonView& json) {
    layers_.thickness = read_factor(file_, json, "thicknessFactor", 0, unbounded);
    layers_.attenuation_color = read_color_factor(file_, json, "attenuationColor", {1, 1, 1});
    if (!json.has("attenuationDistance")) return;
    // A distance of 0 is invalid; the least float above it is as opaque.
    layers_.attenuation_distance = clamped(file_, json, "attenuationDistance", json.number("attenuationDistance"),
                                           std::numeric_limits<float>::min(), std::numeric_limits<float>::max());
  }
  void read_diffuse_transmission(const JsonView& json) {
    layers_.diffuse_transmission = read_factor(file_, json, "diffuseTransmissionFactor", 0);
    layers_.diffuse_transmission_color = read_color_factor(file_, json, "diffuseTransmissionColorFactor", {1, 1, 1});
  }

  /// The specular colour is the reflectance at normal incidence, which an infinite index of refraction leaves as it is
  /// (KHR_materials_specular, "Conversions").
  void read_glossiness(const JsonView& json) {
    layers_.ior = 0;
    layers_.specular = 1;
    layers_.specular_color = read_color_factor(file_, json, "specularFactor", {1, 1, 1});
    layers_.specular_color_texture = texture_(json, "specularGlossinessTexture");
    layers_.glossiness = read_factor(file_, json, "glossinessFactor", 1);
  }

  GltfFile& file_;
  const JsonView& material_;
  const TextureReader& texture_;
  MaterialLayers layers_;
  bool has_any_ = false;
};

}  // namespace

std::shared_ptr<const MaterialLayers> read_layers(GltfFile& file, const JsonView& material,
                                                  const TextureReader& texture) {
  return LayerReader(file, material, texture).read();
}

}  // namespace zoneplate
