// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/stl/stl.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <string_view>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/stl/facets.h"
#include "zoneplate/formats/stl/text.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/geometry/flat_normals.h"
#include "zoneplate/scene/geometry/origin.h"
#include "zoneplate/scene/sanitize.h"

namespace zoneplate {
namespace {

using Bytes = std::span<const std::uint8_t>;

void add_mesh(Scene& scene, Mesh mesh, std::string name, ImportBudget& budget) {
  if (const std::uint64_t dropped = drop_not_finite(mesh).dropped)
    scene.warnings.push_back(fmt::format("{}: {} triangles that are not finite are dropped", budget.file(), dropped));
  if (mesh.index.empty()) return;
  mesh.name = name;
  if (!mesh.color.empty()) scene.materials[0].base_color = {1, 1, 1, 1};
  scene.instances.push_back({static_cast<int>(scene.meshes.size()), static_cast<int>(scene.objects.size()), {}});
  scene.objects.push_back(std::move(name));
  scene.meshes.push_back(std::move(mesh));
}

void read_binary(Bytes bytes, const std::string& name, Scene& scene, ImportBudget& budget) {
  const StlFacets facets = find_stl_facets(bytes, scene, budget);
  add_mesh(scene, read_stl_facets(facets, budget), name, budget);
  center_far_scene(scene);
}

/// The mesh of corners, three for each triangle.
Mesh make_mesh(std::vector<float3> corners) {
  Mesh mesh;
  mesh.normal.reserve(corners.size());
  for (std::size_t c = 0; c < corners.size(); c += 3)
    mesh.normal.insert(mesh.normal.end(), 3, flat_normal(corners[c], corners[c + 1], corners[c + 2]));
  mesh.index.resize(corners.size());
  std::iota(mesh.index.begin(), mesh.index.end(), 0u);
  mesh.position = std::move(corners);
  return mesh;
}

/// Parses the text, and again where its vertices are far from the origin, so that they lose nothing as floats.
StlText parse(std::string_view text, Scene& scene, ImportBudget& budget) {
  const std::uint64_t before = budget.memory_left();
  StlText out = parse_stl_text(text, budget);
  OriginChoice choice;
  choice.add(out.vertices);
  scene.origin = choice.origin();
  if (scene.origin == double3{}) return out;
  out = {};
  budget.give_back(before - budget.memory_left());
  return parse_stl_text(text, budget, scene.origin);
}

void read_text(Bytes bytes, const std::string& name, Scene& scene, ImportBudget& budget) {
  StlText text = parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, scene, budget);
  if (text.vertices.size() > 0xffffffffu / 3) throw Error(ErrorKind::Input, budget.file() + ": more than 2^32 corners");
  budget.take(3 * text.vertices.size() * (2 * sizeof(float3) + sizeof(std::uint32_t)));
  if (text.solids.empty() || text.solids[0].before > 0) text.solids.insert(text.solids.begin(), {0, ""});

  std::vector<Mesh> meshes(text.solids.size());
  std::vector<std::uint64_t> too_short(meshes.size());
  parallel_for(meshes.size(), [&](std::size_t i) {
    const std::uint64_t end = i + 1 < meshes.size() ? text.solids[i + 1].before : text.loops.size() - 1;
    std::vector<float3> corners;
    too_short[i] = add_stl_triangles(text, text.solids[i].before, end, budget, corners);
    meshes[i] = make_mesh(std::move(corners));
  });
  budget.check_time();
  if (const std::uint64_t n = std::accumulate(too_short.begin(), too_short.end(), std::uint64_t{0}))
    scene.warnings.push_back(fmt::format("{}: {} loops have fewer than 3 vertices and are dropped", budget.file(), n));
  for (std::size_t i = 0; i < meshes.size(); ++i)
    add_mesh(scene, std::move(meshes[i]), text.solids[i].name.empty() ? name : text.solids[i].name, budget);
}

}  // namespace

Scene load_stl(const std::string& path, const LoadLimits& limits) {
  const bool is_stream = path == "-";
  const FileBytes file(path, limits.memory);
  ImportBudget budget(is_stream ? "standard input" : path, limits);
  const std::string name = is_stream ? "object" : std::filesystem::path(path).stem().string();

  Scene scene;
  scene.up = {0, 0, 1};
  scene.materials = {plain_material("default")};
  if (is_stl_text(file.bytes()))
    read_text(file.bytes(), name, scene, budget);
  else
    read_binary(file.bytes(), name, scene, budget);
  if (scene.meshes.empty()) throw budget.nothing_to_draw(scene.warnings, "holds no triangles");
  return scene;
}

}  // namespace zoneplate
