// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/obj/layout.h"
#include "zoneplate/formats/obj/libraries.h"
#include "zoneplate/formats/obj/mesh.h"
#include "zoneplate/formats/obj/normals.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/geometry/winding.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

bool has_elements(const ObjFile& file) {
  for (const ObjChunk& chunk : file.chunks)
    if (!chunk.elements.empty()) return true;
  return false;
}

/// Makes a point cloud of all vertices, for a file without elements.
void make_points(ObjFile& file, ImportBudget& budget) {
  budget.take(2 * file.positions.size() * (sizeof(ObjElement) + sizeof(std::int32_t)));
  ObjChunk cloud;
  serial_ranges(file.positions.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      cloud.elements.push_back({static_cast<std::uint32_t>(i), 1, ObjKind::Point});
      cloud.corners.push_back({static_cast<std::int32_t>(i), -1, -1});
    }
  });
  file.chunks.push_back(std::move(cloud));
}

void add_meshes(ObjMeshes found, const ObjLayout& layout, Scene& scene, ImportBudget& budget) {
  scene.objects = layout.objects;
  budget.take(found.meshes.size() * (sizeof(Mesh) + sizeof(Instance)));
  scene.meshes.reserve(found.meshes.size()), scene.instances.reserve(found.meshes.size());
  for (ObjMesh& m : found.meshes) {
    budget.take(layout.objects[static_cast<std::size_t>(m.object)].size());
    m.mesh.name = layout.objects[static_cast<std::size_t>(m.object)];
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), m.object, float4x4{}});
    scene.meshes.push_back(std::move(m.mesh));
  }
}

void report_losses(const ObjMeshes& found, const std::string& name, std::vector<std::string>& warnings) {
  if (found.not_finite > 0)
    warnings.push_back(fmt::format("{}: {} faces, lines or points have a vertex that is not finite and are dropped",
                                   name, found.not_finite));
  if (found.too_concave > 0)
    warnings.push_back(fmt::format("{}: {} polygons have too many corners to be cut rightly", name, found.too_concave));
}

/// MTL has no unit of heights: here, the value 1 lies this part of the texture's width above the value 0, times -bm.
constexpr double height_of_texture = 0.01;

/// The length in space of one unit of texture coordinates, over all triangles of a material; 0 where it has none.
double texture_extent(const Scene& scene, int material, ImportBudget& budget) {
  double area = 0, mapped = 0;
  for (const Mesh& mesh : scene.meshes) {
    if (mesh.material != material || mesh.topology != Topology::Triangles || mesh.uv0.empty()) continue;
    budget.check_time();
    for (std::size_t i = 0; i + 2 < mesh.index.size(); i += 3) {
      const std::uint32_t a = mesh.index[i], b = mesh.index[i + 1], c = mesh.index[i + 2];
      const float3 across = cross(mesh.position[b] - mesh.position[a], mesh.position[c] - mesh.position[a]);
      const float2 e = mesh.uv0[b] - mesh.uv0[a], f = mesh.uv0[c] - mesh.uv0[a];
      area += double{length(across)}, mapped += std::abs(double{e.x} * double{f.y} - double{e.y} * double{f.x});
    }
  }
  const double square = area / mapped;
  return std::isfinite(square) ? std::sqrt(square) : 0;
}

/// Converts the heights of bump maps from parts of a texture's size to units of the model.
void scale_heights(Scene& scene, ImportBudget& budget) {
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    Material& material = scene.materials[m];
    if (material.height_texture.image < 0) continue;
    const float2 repeats = material.height_texture.scale;
    const double root = std::sqrt(std::abs(double{repeats.x} * double{repeats.y}));
    const double size = root > 0 ? texture_extent(scene, static_cast<int>(m), budget) / root : 0;
    const auto scale = static_cast<float>(double{material.height_scale} * height_of_texture * size);
    material.height_scale = std::isfinite(scale) ? scale : 0;
  }
}

}  // namespace

Scene load_obj(const std::string& path, const LoadLimits& limits) {
  const bool is_stream = path == "-";
  const std::string name = is_stream ? "standard input" : path;
  const FileBytes bytes(path, limits.memory);
  const ObjText text = cut_obj(bytes.bytes(), name);
  ImportBudget budget(name, limits);
  Scene scene;
  ObjFile file = parse_obj(text, budget, [&](std::string_view part) { bytes.forget(part.data(), part.size()); });
  scene.origin = file.origin;
  report_obj_notes(file, budget, scene.warnings);
  if (!has_elements(file) && scene.warnings.empty()) make_points(file, budget);

  const std::filesystem::path place(path);
  const ObjLayout layout = lay_out(file, is_stream ? "object" : place.stem().string(), budget);
  budget.take(2 * layout.materials.size() * sizeof(Material));
  const std::vector<std::vector<float3>> normals = missing_normals(file, layout.runs, budget);
  ObjMeshes found = make_meshes(file, layout, normals, budget);
  if (!file.normals.empty())  // normals that are made follow the corners
    for (ObjMesh& m : found.meshes) turn_to_normals(m.mesh);
  file = {};
  report_losses(found, name, scene.warnings);
  if (found.meshes.empty())
    throw Error(ErrorKind::Input, scene.warnings.empty()
                                      ? name + ": holds no faces, lines or points"
                                      : scene.warnings.front() + "; nothing is left that can be drawn");
  add_meshes(std::move(found), layout, scene, budget);

  ModelFolder folder(is_stream ? "." : place.parent_path().string(), budget, scene);
  add_obj_materials(layout, folder);
  scale_heights(scene, budget);
  return scene;
}

}  // namespace zoneplate
