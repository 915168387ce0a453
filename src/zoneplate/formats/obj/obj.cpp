// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/text_scan.h"
#include "zoneplate/formats/obj/layout.h"
#include "zoneplate/formats/obj/mesh.h"
#include "zoneplate/formats/obj/mtl_material.h"
#include "zoneplate/formats/obj/normals.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

std::string_view text_of(const FileBytes& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

/// The used materials by name. If several libraries define a material, the first definition is used.
class Libraries {
 public:
  Libraries(ModelFolder& folder, const std::vector<std::string>& used)
      : folder_(folder), used_(used.begin(), used.end()) {
    folder.budget().take(used.size() * (sizeof(std::string_view) + 48));
  }

  /// Adds the operand of an mtllib statement: one name that may contain spaces, or several.
  void add(const std::string& statement) {
    if (names_ >= max_names) return void(++names_);
    if (!statements_.insert(statement).second) return;
    ++names_;
    if (folder_.find_file("", statement)) return open(statement);
    LineWords words(statement);
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      if (++names_ <= max_names) open(std::string(word));
  }

  Material material(const std::string& name) {
    const auto found = materials_.find(name);
    if (found != materials_.end()) return make_material(found->second.material, found->second.within, folder_);
    if (!name.empty() && ++undefined_ <= max_named)
      folder_.scene().warnings.push_back(fmt::format("{}: material {} is not defined", folder_.budget().file(), name));
    return plain_material(name.empty() ? "default" : name);
  }

  void report_rest() {
    const auto report = [&](std::size_t count, const char* text) {
      if (count > max_named)
        folder_.scene().warnings.push_back(
            fmt::format("{}: {} more {}", folder_.budget().file(), count - max_named, text));
    };
    if (names_ > max_names)
      folder_.scene().warnings.push_back(fmt::format("{}: names more than {} material libraries, the rest is ignored",
                                                     folder_.budget().file(), max_names));
    report(missing_, "material libraries are not found");
    report(undefined_, "materials are not defined");
  }

 private:
  static constexpr std::size_t max_named = 20;
  static constexpr std::size_t max_names = 1000;  ///< maximum number of libraries, because each takes a file search

  struct Found {
    MtlMaterial material;
    std::string within;
  };

  /// Whether a material is used and not yet defined; if so, its memory is charged to the budget.
  bool is_used(const std::string& name) {
    constexpr std::uint64_t of_the_table = 64;
    if (!used_.contains(name) || materials_.contains(name)) return false;
    folder_.budget().check_time();
    folder_.budget().take(2 * sizeof(Found) + 2 * name.size() + of_the_table);
    return true;
  }

  void open(const std::string& name) {
    Scene& scene = folder_.scene();
    folder_.budget().check_time();
    const std::optional<std::string> path = folder_.find_file("", name);
    if (!path) {
      if (++missing_ <= max_named)
        scene.warnings.push_back(
            fmt::format("{}: material library {}", folder_.budget().file(), folder_.missing_text("", name)));
      return;
    }
    if (!opened_.insert(*path).second) return;
    const FileBytes file = folder_.open(*path);
    const std::size_t slash = name.find_last_of("/\\");
    const std::string within = slash == name.npos ? "" : name.substr(0, slash + 1);
    std::vector<MtlMaterial> found =
        parse_mtl(text_of(file), name, scene.warnings, [&](const std::string& m) { return is_used(m); });
    for (MtlMaterial& m : found) {
      std::string key = m.name;
      materials_.try_emplace(std::move(key), Found{std::move(m), within});
    }
  }

  // Maps and sets, not hash tables, because a malicious file could choose names that collide.
  ModelFolder& folder_;
  std::set<std::string_view> used_;
  std::size_t names_ = 0, missing_ = 0, undefined_ = 0;
  std::map<std::string, Found> materials_;
  std::set<std::string> statements_, opened_;
};

void report_notes(const ObjFile& file, const ImportBudget& budget, std::vector<std::string>& warnings) {
  constexpr const char* texts[] = {"has too few corners and is dropped",
                                   "is dropped",
                                   "is free-form geometry, which is not drawn",
                                   "is unknown and ignored",
                                   "is not finite and set to 0",
                                   "index out of range, treated as absent",
                                   "index out of range, treated as absent"};
  for (std::size_t kind = 0; kind < std::size(texts); ++kind) {
    ObjTally sum;
    for (const ObjChunk& chunk : file.chunks) {
      const ObjTally& tally = chunk.notes[kind];
      if (sum.count == 0) sum.line = tally.line, sum.word = tally.word;
      sum.count += tally.count;
    }
    if (sum.count == 0) continue;
    const std::string more = sum.count > 1 ? fmt::format(" (and {} more)", sum.count - 1) : "";
    const std::string text = fmt::format("{}: line {}: {} {}{}", budget.file(), sum.line, sum.word, texts[kind], more);
    if (kind == static_cast<std::size_t>(ObjNote::BadCorner))
      budget.warn_of_flaw(warnings, text);
    else
      warnings.push_back(text);
  }
}

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
  if (const std::string_view mark = text_of(bytes).substr(0, 2); mark == "\xff\xfe" || mark == "\xfe\xff")
    throw Error(ErrorKind::Input, name + ": is text in UTF-16, expected UTF-8 or ASCII");
  ImportBudget budget(name, limits);
  Scene scene;
  ObjFile file =
      parse_obj(text_of(bytes), budget, [&](std::string_view part) { bytes.forget(part.data(), part.size()); });
  scene.origin = file.origin;
  report_notes(file, budget, scene.warnings);
  if (!has_elements(file) && scene.warnings.empty()) make_points(file, budget);

  const std::filesystem::path place(path);
  const ObjLayout layout = lay_out(file, is_stream ? "object" : place.stem().string(), budget);
  budget.take(2 * layout.materials.size() * sizeof(Material));
  const std::vector<std::vector<float3>> normals = missing_normals(file, layout.runs, budget);
  ObjMeshes found = make_meshes(file, layout, normals, budget);
  file = {};
  report_losses(found, name, scene.warnings);
  if (found.meshes.empty())
    throw Error(ErrorKind::Input, scene.warnings.empty()
                                      ? name + ": holds no faces, lines or points"
                                      : scene.warnings.front() + "; nothing is left that can be drawn");
  add_meshes(std::move(found), layout, scene, budget);

  ModelFolder folder(is_stream ? "." : place.parent_path().string(), budget, scene);
  Libraries libraries(folder, layout.materials);
  for (const std::string& statement : layout.libraries) libraries.add(statement);
  for (const std::string& material : layout.materials) {
    budget.check_time();
    scene.materials.push_back(libraries.material(material));
  }
  libraries.report_rest();
  scale_heights(scene, budget);
  return scene;
}

}  // namespace zoneplate
