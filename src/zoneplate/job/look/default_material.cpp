// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/look/default_material.h"

#include <algorithm>
#include <utility>

#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {
namespace {

TextureImage read_texture(const std::string& path, const LoadLimits& limits, std::vector<std::string>& warnings) {
  const MappedFileWatch watch;
  const FileBytes file(path, limits.memory);
  ImportBudget(path, limits).take(decoded_image_memory(file.bytes()) + image_working_memory(file.bytes()));
  DecodedImage decoded = decode_image(file.bytes(), path, limits);
  if (!decoded.flaw.empty()) warnings.push_back(std::move(decoded.flaw));
  TextureImage image{path, std::move(decoded.texels)};
  watch.check(path);
  return image;
}

void set_look(const DefaultMaterial& look, int image, Material& material) {
  if (look.metallic || look.roughness) {
    convert_material(material, ShadingModel::MetallicRoughness);
    if (look.metallic) material.metallic = *look.metallic;
    if (look.roughness) material.roughness = *look.roughness;
  }
  if (image >= 0) material.base_color_texture = {.image = image};
  if (look.color || image >= 0) material.base_color = look.color.value_or(float4{1, 1, 1, 1});
  if (look.color && look.color->w < 1) material.alpha_mode = AlphaMode::Blend;
  material.ambient = xyz(material.base_color);
}

}  // namespace

void set_default_material(const DefaultMaterial& look, const LoadLimits& limits, Scene& scene) {
  if (!look.is_set()) return;
  if (std::ranges::none_of(scene.materials, &Material::is_default)) {
    scene.warnings.push_back("--color, --metallic, --roughness and --texture have no effect: the model has materials");
    return;
  }
  int image = -1;
  if (!look.texture.empty()) {
    image = static_cast<int>(scene.images.size());
    scene.images.push_back(read_texture(look.texture, limits, scene.warnings));
    const auto has_no_place = [&](const Mesh& mesh) {
      return scene.materials[static_cast<std::size_t>(mesh.material)].is_default && mesh.uv0.empty();
    };
    if (std::ranges::any_of(scene.meshes, has_no_place))
      scene.warnings.push_back("--texture: the model has no texture coordinates, so that one texel colours all of it");
  }
  for (Material& material : scene.materials)
    if (material.is_default) set_look(look, image, material);
}

}  // namespace zoneplate
