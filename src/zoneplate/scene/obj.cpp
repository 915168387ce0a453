#include "zoneplate/scene/obj.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/file.h"
#include "zoneplate/scene/mtl_material.h"
#include "zoneplate/scene/obj_layout.h"
#include "zoneplate/scene/obj_mesh.h"
#include "zoneplate/scene/obj_normals.h"
#include "zoneplate/scene/obj_text.h"

namespace zoneplate {
namespace {

std::string_view text_of(const FileBytes& file) {
  return {reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()};
}

/// The materials of all libraries by name; the first of a name counts.
class Libraries {
 public:
  explicit Libraries(ObjFolder& folder) : folder_(folder) {}

  /// What an mtllib statement says: one name that may hold spaces, or several.
  void add(const std::string& statement) {
    if (folder_.find_file("", statement)) return open(statement);
    LineWords words(statement);
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) open(std::string(word));
  }

  Material material(const std::string& name) {
    const auto found = materials_.find(name);
    if (found != materials_.end()) return make_material(found->second.material, found->second.within, folder_);
    if (!name.empty())
      folder_.scene().warnings.push_back(fmt::format("{}: material {} is not defined", folder_.budget().file(), name));
    return plain_material(name.empty() ? "default" : name);
  }

 private:
  struct Found {
    MtlMaterial material;
    std::string within;
  };

  void open(const std::string& name) {
    Scene& scene = folder_.scene();
    const std::optional<std::string> path = folder_.find_file("", name);
    if (!path) {
      scene.warnings.push_back(
          fmt::format("{}: material library {} not found in the model's folder", folder_.budget().file(), name));
      return;
    }
    if (!opened_.try_emplace(*path, true).second) return;
    const FileBytes file(*path, folder_.budget().limits().memory);
    const std::size_t slash = name.find_last_of("/\\");
    const std::string within = slash == name.npos ? "" : name.substr(0, slash + 1);
    for (MtlMaterial& m : parse_mtl(text_of(file), name, scene.warnings)) {
      std::string key = m.name;
      materials_.try_emplace(std::move(key), Found{std::move(m), within});
    }
  }

  ObjFolder& folder_;
  std::unordered_map<std::string, Found> materials_;
  std::unordered_map<std::string, bool> opened_;
};

void report_notes(const ObjFile& file, const std::string& name, std::vector<std::string>& warnings) {
  constexpr const char* texts[] = {"has too few corners and is dropped", "is free-form geometry, which is not drawn",
                                   "is not known and passed over",       "is not finite and taken as 0",
                                   "index out of range, taken as none",  "index out of range, taken as none"};
  for (std::size_t kind = 0; kind < std::size(texts); ++kind) {
    ObjTally sum;
    for (const ObjChunk& chunk : file.chunks) {
      const ObjTally& tally = chunk.notes[kind];
      if (sum.count == 0) sum.line = tally.line, sum.word = tally.word;
      sum.count += tally.count;
    }
    if (sum.count == 0) continue;
    const std::string more = sum.count > 1 ? fmt::format(" (and {} more)", sum.count - 1) : "";
    warnings.push_back(fmt::format("{}: line {}: {} {}{}", name, sum.line, sum.word, texts[kind], more));
  }
}

bool has_elements(const ObjFile& file) {
  for (const ObjChunk& chunk : file.chunks)
    if (!chunk.elements.empty()) return true;
  return false;
}

/// A file of nothing but vertices is a cloud of points.
void make_points(ObjFile& file) {
  ObjChunk cloud;
  for (std::size_t i = 0; i < file.positions.size(); ++i) {
    cloud.elements.push_back({static_cast<std::uint32_t>(i), 1, ObjKind::Point});
    cloud.corners.push_back({static_cast<std::int32_t>(i), -1, -1});
  }
  file.chunks.push_back(std::move(cloud));
}

void add_meshes(ObjMeshes found, const ObjLayout& layout, Scene& scene) {
  scene.objects = layout.objects;
  for (ObjMesh& m : found.meshes) {
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

}  // namespace

Scene load_obj(const std::string& path, const LoadLimits& limits) {
  const bool is_stream = path == "-";
  const std::string name = is_stream ? "standard input" : path;
  const FileBytes bytes(path, limits.memory);
  ImportBudget budget(name, limits);
  Scene scene;
  ObjFile file =
      parse_obj(text_of(bytes), budget, [&](std::string_view part) { bytes.forget(part.data(), part.size()); });
  report_notes(file, name, scene.warnings);
  if (!has_elements(file) && scene.warnings.empty()) make_points(file);

  const std::filesystem::path place(path);
  const ObjLayout layout = lay_out(file, is_stream ? "object" : place.stem().string());
  const std::vector<std::vector<float3>> normals = missing_normals(file, layout.runs, budget);
  ObjMeshes found = make_meshes(file, layout, normals, budget);
  file = {};
  report_losses(found, name, scene.warnings);
  if (found.meshes.empty())
    throw Error(Trouble::Input, scene.warnings.empty()
                                    ? name + ": holds no faces, lines or points"
                                    : scene.warnings.front() + "; nothing is left that can be drawn");
  add_meshes(std::move(found), layout, scene);

  ObjFolder folder(is_stream ? "." : place.parent_path().string(), budget, scene);
  Libraries libraries(folder);
  for (const std::string& statement : layout.libraries) libraries.add(statement);
  for (const std::string& material : layout.materials) scene.materials.push_back(libraries.material(material));
  return scene;
}

}  // namespace zoneplate
