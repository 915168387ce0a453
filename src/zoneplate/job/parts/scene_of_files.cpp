// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/parts/scene_of_files.h"

#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/scene/default_options.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

/// What the other ranks know of a file.
struct FileHead {
  std::uint32_t file, instances, objects, materials, lights;
  bool needs_fill_light, has_environment;
  float3 up, ambient_light;
  double3 origin;
  Box bounds;
  double points;
};
struct InstanceHead {
  std::uint32_t material, triangles;
};
struct MaterialHead {
  ShadingModel model;
  AlphaMode alpha_mode;
  bool is_default;
};

std::uint32_t number(std::size_t count) { return static_cast<std::uint32_t>(count); }

std::uint32_t triangles_of(const Mesh& mesh) {
  return number(mesh.topology == Topology::Triangles ? mesh.primitives() : 2 * mesh.primitives());
}

/// Only `name` is left out.
template <class Use>
void for_members(Light& light, Use use) {
  use(light.kind), use(light.is_in_camera_space), use(light.color), use(light.intensity), use(light.position);
  use(light.direction), use(light.range), use(light.falloff), use(light.attenuation), use(light.inner_cone);
  use(light.outer_cone), use(light.radius);
}

void pack(std::size_t file, const Scene& scene, ByteBuffer& out) {
  out.put(FileHead{.file = number(file),
                   .instances = number(scene.instances.size()),
                   .objects = number(scene.objects.size()),
                   .materials = number(scene.materials.size()),
                   .lights = number(scene.lights.size()),
                   .needs_fill_light = scene.needs_fill_light,
                   .has_environment = !(scene.environment == Environment{}),
                   .up = scene.up,
                   .ambient_light = scene.ambient_light,
                   .origin = scene.origin,
                   .bounds = scene.bounds(),
                   .points = points_of(scene)});
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    out.put(InstanceHead{number(static_cast<std::size_t>(mesh.material)), triangles_of(mesh)});
  }
  for (const Material& material : scene.materials)
    out.put(MaterialHead{material.model, material.alpha_mode, material.is_default});
  for (Light light : scene.lights) for_members(light, [&](const auto& member) { out.put(member); });
}

/// Moves the texture uses of a material by a number of images.
void move_images(Material& material, int images) {
  const auto move = [&](TextureUse& use) {
    if (use.image >= 0) use.image += images;
  };
  for (const MaterialTextureSlot& slot : material_texture_slots) move(material.*slot.use);
  if (!material.layers) return;
  auto layers = std::make_shared<MaterialLayers>(*material.layers);
  for (const LayerTextureSlot& slot : layer_texture_slots) move((*layers).*slot.use);
  material.layers = std::move(layers);
}

/// Appends a file of this rank.
void append(Scene part, SceneOfFiles& out) {
  Scene& all = out.scene;
  const int meshes = static_cast<int>(all.meshes.size()), materials = static_cast<int>(all.materials.size()),
            objects = static_cast<int>(all.objects.size()), images = static_cast<int>(all.images.size());
  for (Mesh& mesh : part.meshes) {
    mesh.material += materials;
    all.meshes.push_back(std::move(mesh));
  }
  for (Instance instance : part.instances) {
    instance.mesh += meshes, instance.object += objects;
    all.instances.push_back(instance);
    out.elsewhere.push_back(0);
  }
  for (Material& material : part.materials) {
    move_images(material, images);
    all.materials.push_back(std::move(material));
  }
  for (TextureImage& image : part.images) all.images.push_back(std::move(image));
  for (const std::string& name : part.objects) all.objects.push_back(name);
  for (Light& light : part.lights) all.lights.push_back(std::move(light));
  for (std::string& warning : part.warnings) all.warnings.push_back(std::move(warning));
}

/// Appends a file of another rank: an empty mesh for each of its materials, and the counts.
void append(const FileHead& head, ByteReader& reader, SceneOfFiles& out) {
  Scene& all = out.scene;
  const int meshes = static_cast<int>(all.meshes.size()), materials = static_cast<int>(all.materials.size()),
            objects = static_cast<int>(all.objects.size());
  for (std::uint32_t i = 0; i < head.instances; ++i) {
    const auto of = reader.take<InstanceHead>();
    Instance& instance = all.instances.emplace_back();
    instance.mesh = meshes + static_cast<int>(of.material), instance.object = objects;
    out.elsewhere.push_back(of.triangles);
  }
  for (std::uint32_t m = 0; m < head.materials; ++m) {
    const auto of = reader.take<MaterialHead>();
    Material& material = all.materials.emplace_back();
    material.model = of.model, material.alpha_mode = of.alpha_mode, material.is_default = of.is_default;
    material.base_color = {0, 0, 0, 1};
    all.meshes.emplace_back().material = materials + static_cast<int>(m);
  }
  for (std::uint32_t i = 0; i < head.lights; ++i)
    for_members(all.lights.emplace_back(),
                [&](auto& member) { member = reader.take<std::decay_t<decltype(member)>>(); });
  for (std::uint32_t i = 0; i < head.objects; ++i) all.objects.push_back("");
}

void check(const FileHead& head, const FileHead& first, const std::string& name) {
  const auto refuse = [&](const char* what) { throw Error(ErrorKind::Input, name + ": " + what); };
  if (head.has_environment) refuse("has an environment of its own, which cannot be joined to other files");
  if (!(head.up == first.up)) refuse("has another up axis than the first file; see --up");
  if (!(head.origin == first.origin)) refuse("lies far from the origin, in other coordinates than the first file");
}

}  // namespace

SceneOfFiles join_files(const std::vector<std::string>& files, std::vector<Scene> own, Ranks& ranks) {
  ByteBuffer packed;
  for (std::size_t file = 0; file < files.size(); ++file)
    if (rank_of_file(file, files.size(), ranks.count()) == ranks.rank()) pack(file, own[file], packed);
  std::vector<ByteBuffer> to(static_cast<std::size_t>(ranks.count()));
  for (ByteBuffer& buffer : to) buffer.append(packed.bytes());
  std::vector<ByteBuffer> from = ranks.exchange(to);
  from[static_cast<std::size_t>(ranks.rank())] = std::move(packed);

  // The files of a rank are consecutive, and so are those of all ranks.
  SceneOfFiles out;
  std::optional<FileHead> first;
  for (std::size_t r = 0; r < from.size(); ++r) {
    ByteReader reader(from[r].bytes());
    while (!reader.is_at_end()) {
      const auto head = reader.take<FileHead>();
      if (!first) {
        first = head;
        out.scene.up = head.up, out.scene.origin = head.origin, out.scene.ambient_light = head.ambient_light;
      }
      check(head, *first, files[head.file]);
      out.scene.needs_fill_light = out.scene.needs_fill_light || head.needs_fill_light;
      out.bounds.push_back(head.bounds);
      out.points += head.points;
      if (static_cast<int>(r) != ranks.rank()) {
        append(head, reader, out);
        continue;
      }
      SceneOfFiles skipped;
      append(head, reader, skipped);
      append(std::move(own[head.file]), out);
    }
  }
  return out;
}

Scene scene_of_bounds(std::span<const Box> bounds, const Scene& scene) {
  Scene points;
  points.up = scene.up, points.origin = scene.origin;
  points.materials.emplace_back();
  Mesh& mesh = points.meshes.emplace_back();
  mesh.topology = Topology::Points;
  for (const Box& box : bounds)
    for (int i = 0; i < 8 && !box.empty(); ++i) {
      mesh.index.push_back(static_cast<std::uint32_t>(mesh.position.size()));
      mesh.position.push_back(box.corner(i));
    }
  points.instances.emplace_back();
  return points;
}

}  // namespace zoneplate
