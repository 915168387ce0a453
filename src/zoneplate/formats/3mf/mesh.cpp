// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/3mf/mesh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/3mf/package.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/scene/geometry/smooth_normals.h"

namespace zoneplate {
namespace {

using namespace model_3mf;

float4 light_of(Rgba8 p) {
  return {decode_srgb8(p.r), decode_srgb8(p.g), decode_srgb8(p.b), static_cast<float>(p.a) / 255};
}
float4 light_of(Rgba16 p) {
  constexpr float most = 65535;
  return {decode_srgb(static_cast<float>(p.r) / most), decode_srgb(static_cast<float>(p.g) / most),
          decode_srgb(static_cast<float>(p.b) / most), static_cast<float>(p.a) / most};
}
float4 light_of(float4 p) { return p; }

void set_light(Rgba8& p, float3 light) {
  p = {encode_srgb8(light.x), encode_srgb8(light.y), encode_srgb8(light.z), 255};
}
void set_light(Rgba16& p, float3 light) {
  const auto code = [](float linear) { return static_cast<std::uint16_t>(encode_srgb(linear) * 65535 + 0.5f); };
  p = {code(light.x), code(light.y), code(light.z), 65535};
}
void set_light(float4& p, float3 light) { p = {light.x, light.y, light.z, 1}; }

/// Lays the texels of an image with alpha over a colour, in linear light.
TexelImage laid_over(const TexelImage& image, float3 below, const ImportBudget& budget) {
  return image.visit([&](auto texels) -> TexelImage {
    for (int y = 0; y < texels.height(); ++y) {
      budget.check_time();
      for (auto& texel : texels.row(y)) {
        const float4 light = light_of(texel);
        if (light.w >= 1) continue;
        set_light(texel, light.w > 0 ? xyz(light) * light.w + below * (1 - light.w) : below);
      }
    }
    return texels;
  });
}

}  // namespace

const std::vector<int>& MeshMaker3mf::meshes_of(const Model& model, Object& object) {
  const auto found = made_.find(&object);
  if (found != made_.end()) return found->second;
  budget_.take(128);
  return made_.emplace(&object, make(model, object)).first->second;
}

int MeshMaker3mf::default_material() {
  if (default_material_ >= 0) return default_material_;
  budget_.take(2 * sizeof(Material));
  scene_.materials.push_back(plain_material("default"));
  return default_material_ = static_cast<int>(scene_.materials.size()) - 1;
}

/// The image of a texture, whose part is unpacked at its first use; -1 if it cannot be loaded.
int MeshMaker3mf::image_of(const Model& model, const PropertyGroup& group) {
  const auto texture = model.textures.find(group.texture);
  const std::string part = texture == model.textures.end() ? "" : part_name(texture->second.path);
  const float4 below = group.below;
  budget_.take(part.size() + 128);
  const auto [entry, is_new] =
      images_.try_emplace({part, std::array<float, 4>{below.x, below.y, below.z, below.w}}, -1);
  if (!is_new) return entry->second;
  std::optional<std::vector<std::uint8_t>> bytes;
  try {
    if (!part.empty()) bytes = contents_(part);
  } catch (const Error&) {
    budget_.take(0), budget_.check_time();  // exceeded limits are errors nevertheless
    flaws_.add(Flaw::Texture, [&] { return fmt::format("texture {} cannot be unpacked", part); });
    return -1;
  }
  if (!bytes) {
    flaws_.add(Flaw::Texture, [&] {
      return part.empty() ? fmt::format("a texture coordinate group of {} names no texture with a path", model.part)
                          : fmt::format("texture {} is not in the package", part);
    });
    return -1;
  }
  const std::string names[] = {printable(part)};
  const int image = files_.embed(names, *bytes);
  budget_.give_back(bytes->size());
  if (image >= 0 && below.w > 0) {
    TexelImage& pixels = scene_.images[static_cast<std::size_t>(image)].pixels;
    const std::uint64_t of_a_copy = pixels.visit([](const auto& texels) { return texels.values().size_bytes(); });
    budget_.take(of_a_copy);
    pixels = laid_over(pixels, xyz(below), budget_);
    budget_.give_back(of_a_copy);
  }
  return entry->second = image;
}

Material MeshMaker3mf::make_material(const Model& model, const PropertyGroup& group, std::uint32_t index,
                                     bool is_clear) {
  Material material = plain_material(index < group.names.size() ? group.names[index] : "");
  material.is_default = false;
  if (is_clear) material.alpha_mode = AlphaMode::Blend;
  if (group.is_base) {
    material.base_color = group.color[index];
    material.ambient = xyz(group.color[index]);
    return material;
  }
  if (material.name.empty()) material.name = group.uv.empty() ? "colors" : "texture";
  material.base_color = {1, 1, 1, 1};
  material.ambient = {1, 1, 1};
  if (group.uv.empty()) return material;
  material.base_color_texture.image = image_of(model, group);
  const auto texture = model.textures.find(group.texture);
  if (texture != model.textures.end()) material.base_color_texture.sampler = texture->second.sampler;
  if (material.base_color_texture.image < 0) {
    const Material plain = plain_material("");
    material.base_color = plain.base_color, material.ambient = plain.ambient;
  }
  return material;
}

int MeshMaker3mf::material_of(const Model& model, std::uint32_t group_id, const PropertyGroup& group,
                              std::uint32_t index, bool is_clear) {
  const auto [entry, is_new] = materials_.try_emplace({&model, group_id, group.is_base ? index : none, is_clear}, 0);
  if (!is_new) return entry->second;
  budget_.take(2 * sizeof(Material) + 128);
  Material material = make_material(model, group, index, is_clear);
  scene_.materials.push_back(std::move(material));
  return entry->second = static_cast<int>(scene_.materials.size()) - 1;
}

MeshMaker3mf::Found MeshMaker3mf::find(const Model& model, const Object& object, TriangleProperty property) {
  if (property.group == none) property.group = object.group;
  if (property.index[0] == none) property.index[0] = object.index;
  for (std::uint32_t& index : property.index)
    if (index == none) index = property.index[0];
  if (property.group == none) return {default_material()};
  const auto found = model.groups.find(property.group);
  const std::size_t size = found == model.groups.end() ? 0 : found->second.size();
  const auto strays =
      std::find_if(property.index.begin(), property.index.end(), [&](std::uint32_t index) { return index >= size; });
  if (strays != property.index.end()) {
    flaws_.add(Flaw::Property, [&] {
      return fmt::format("{} has property {} of group {}, which has {}: it is left out", object.name,
                         *strays == none ? "none" : std::to_string(*strays), property.group, size);
    });
    return {default_material()};
  }
  const PropertyGroup& group = found->second;
  const auto is_clear = [&](std::uint32_t index) { return !group.color.empty() && group.color[index].w < 1; };
  if (group.is_base) {
    const std::uint32_t index = property.index[0];  // materials are not interpolated
    return {material_of(model, property.group, group, index, is_clear(index))};
  }
  const bool is_any_clear = group.has_alpha && std::any_of(property.index.begin(), property.index.end(), is_clear);
  return {material_of(model, property.group, group, 0, is_any_clear), &group, property.index};
}

int MeshMaker3mf::add_mesh(Mesh mesh, const Object& object, int material) {
  budget_.take(2 * sizeof(Mesh) + object.name.size());
  mesh.name = object.name;
  mesh.material = material;
  scene_.meshes.push_back(std::move(mesh));
  return static_cast<int>(scene_.meshes.size()) - 1;
}

/// The mesh of some triangles of one material. A vertex is there once for each property that its corners have, in the
/// order of the vertices.
Mesh MeshMaker3mf::part_of(const Mesh& mesh, std::span<const Found> found, std::span<const std::uint32_t> triangles) {
  /// The vertex and, in the low half, the property of a corner.
  struct Corner {
    std::uint64_t key;
    std::size_t place;
    bool operator<(const Corner& other) const { return key < other.key; }
  };
  const PropertyGroup* const group = found[triangles.front()].group;
  const bool has_color = group != nullptr && !group->color.empty(), has_uv = group != nullptr && !group->uv.empty();
  const std::uint64_t of_the_corners = triangles.size() * 3 * sizeof(Corner);
  budget_.take(of_the_corners + triangles.size() * 3 *
                                    (sizeof(std::uint32_t) + 2 * sizeof(float3) + (has_color ? sizeof(float4) : 0) +
                                     (has_uv ? sizeof(float2) : 0)));
  std::vector<Corner> corners;
  corners.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles)
    for (std::size_t c = 0; c < 3; ++c)
      corners.push_back(
          {std::uint64_t{mesh.index[3 * t + c]} << 32 | (group != nullptr ? found[t].index[c] : 0), corners.size()});
  std::sort(corners.begin(), corners.end());
  budget_.check_time();
  Mesh part;
  part.index.resize(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint64_t key = corners[i].key;
    if (i == 0 || key != corners[i - 1].key) {
      const auto vertex = static_cast<std::size_t>(key >> 32), property = static_cast<std::size_t>(key & 0xffffffff);
      part.position.push_back(mesh.position[vertex]);
      part.normal.push_back(mesh.normal[vertex]);
      if (has_uv) part.uv0.push_back(group->uv[property]);
      if (has_color) {
        const float4 color = group->color[property];
        part.color.push_back(group->has_alpha ? color : float4{color.x, color.y, color.z, 1});
      }
    }
    part.index[corners[i].place] = static_cast<std::uint32_t>(part.position.size() - 1);
  }
  budget_.give_back(of_the_corners);
  return part;
}

std::vector<int> MeshMaker3mf::make(const Model& model, Object& object) {
  if (object.triangles.empty()) return {};
  Mesh mesh;
  mesh.position = std::move(object.position);
  mesh.index = std::move(object.triangles);
  // As for PLY: a sum per vertex; a vertex per corner in the worst case, and a copy of those.
  budget_.take(mesh.position.size() * 28 + mesh.index.size() * (sizeof(float3) + 2 * sizeof(std::uint32_t) + 48));
  make_smooth_normals(mesh);
  budget_.check_time();
  if (object.properties.empty()) {
    const Found found = find(model, object, {});
    if (found.group == nullptr) return {add_mesh(std::move(mesh), object, found.material)};
  }

  // The triangles of each material, in the order of the file.
  const std::size_t count = mesh.primitives();
  budget_.take(count * (sizeof(Found) + 2 * sizeof(std::uint32_t)));
  std::vector<Found> found;
  found.reserve(count);
  for (std::size_t t = 0; t < count; ++t) {
    constexpr std::size_t triangles_per_check = 1 << 14;
    if (t % triangles_per_check == 0) budget_.check_time();
    found.push_back(find(model, object, object.properties.empty() ? TriangleProperty{} : object.properties[t]));
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto material_of = [&](std::uint32_t t) { return found[t].material; };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return material_of(a) < material_of(b); });
  std::vector<int> meshes;
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && material_of(order[end]) == material_of(order[begin])) ++end;
    budget_.check_time();
    meshes.push_back(add_mesh(part_of(mesh, found, std::span(order).subspan(begin, end - begin)), object,
                              material_of(order[begin])));
  }
  return meshes;
}

}  // namespace zoneplate
