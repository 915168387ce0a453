// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/look/default_material.h"

#include <algorithm>
#include <utility>

#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/scene/geometry/tangent.h"
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

/// Indices into Scene::images; -1: none.
struct LookImages {
  int base_color = -1, normal = -1, height = -1;
};

void set_look(const DefaultMaterial& look, const LookImages& images, float height_scale, Material& material) {
  if (look.metallic || look.roughness) {
    convert_material(material, ShadingModel::MetallicRoughness);
    if (look.metallic) material.metallic = *look.metallic;
    if (look.roughness) material.roughness = *look.roughness;
  }
  if (images.base_color >= 0) material.base_color_texture = {.image = images.base_color};
  if (images.normal >= 0) material.normal_texture = {.image = images.normal};
  if (images.height >= 0) material.height_texture = {.image = images.height}, material.height_scale = height_scale;
  if (look.color || images.base_color >= 0) material.base_color = look.color.value_or(float4{1, 1, 1, 1});
  if (look.color && look.color->w < 1) material.alpha_mode = AlphaMode::Blend;
  material.ambient = xyz(material.base_color);
}

}  // namespace

void set_default_material(const DefaultMaterial& look, const LoadLimits& limits, Scene& scene) {
  if (!look.is_set()) return;
  if (std::ranges::none_of(scene.materials, &Material::is_default)) {
    scene.warnings.push_back(
        "--color, --metallic, --roughness, --texture, --normal-map and --height-map have no effect: the model has "
        "materials");
    return;
  }
  const auto read = [&](const std::string& path) {
    if (path.empty()) return -1;
    scene.images.push_back(read_texture(path, limits, scene.warnings));
    return static_cast<int>(scene.images.size()) - 1;
  };
  const LookImages images{read(look.texture), read(look.normal_map), read(look.height_map)};
  const auto is_default = [&](const Mesh& mesh) {
    return scene.materials[static_cast<std::size_t>(mesh.material)].is_default;
  };
  if (!look.files().empty() &&
      std::ranges::any_of(scene.meshes, [&](const Mesh& mesh) { return is_default(mesh) && mesh.uv0.empty(); }))
    scene.warnings.push_back("--texture: the model has no texture coordinates, so that one texel colours all of it");
  if (images.normal >= 0)
    for (Mesh& mesh : scene.meshes)
      if (is_default(mesh) && mesh.topology == Topology::Triangles && !mesh.uv0.empty() && !mesh.normal.empty())
        make_tangents(mesh, 0);
  const Box box = scene.bounds();
  const float3 size = box.empty() ? float3{} : box.size();
  const float height = look.height_scale.value_or(std::max({size.x, size.y, size.z}) / 100);
  for (Material& material : scene.materials)
    if (material.is_default) set_look(look, images, height, material);
}

}  // namespace zoneplate
