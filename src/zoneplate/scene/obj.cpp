#include "zoneplate/scene/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
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
    if (!statements_.insert(statement).second) return;
    if (folder_.find_file("", statement)) return open(statement);
    LineWords words(statement);
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) open(std::string(word));
  }

  Material material(const std::string& name) {
    const auto found = materials_.find(name);
    if (found != materials_.end()) return make_material(found->second.material, found->second.within, folder_);
    if (!name.empty() && ++undefined_ <= most_named)
      folder_.scene().warnings.push_back(fmt::format("{}: material {} is not defined", folder_.budget().file(), name));
    return plain_material(name.empty() ? "default" : name);
  }

  void report_rest() {
    const auto report = [&](std::size_t count, const char* text) {
      if (count > most_named)
        folder_.scene().warnings.push_back(
            fmt::format("{}: {} more {}", folder_.budget().file(), count - most_named, text));
    };
    report(missing_, "material libraries are not found");
    report(undefined_, "materials are not defined");
  }

 private:
  static constexpr std::size_t most_named = 20;

  struct Found {
    MtlMaterial material;
    std::string within;
  };

  void open(const std::string& name) {
    Scene& scene = folder_.scene();
    folder_.budget().check_time();
    const std::optional<std::string> path = folder_.find_file("", name);
    if (!path) {
      if (++missing_ <= most_named)
        scene.warnings.push_back(
            fmt::format("{}: material library {} not found in the model's folder", folder_.budget().file(), name));
      return;
    }
    if (!opened_.insert(*path).second) return;
    const FileBytes file(*path, folder_.budget().limits().memory);
    const std::size_t slash = name.find_last_of("/\\");
    const std::string within = slash == name.npos ? "" : name.substr(0, slash + 1);
    // A line may be a material.
    const auto is_end = [](std::uint8_t c) { return c == '\n' || c == '\r'; };
    const auto lines = static_cast<std::size_t>(std::count_if(file.bytes().begin(), file.bytes().end(), is_end)) + 1;
    folder_.budget().take(lines * sizeof(Found));
    std::vector<MtlMaterial> found = parse_mtl(text_of(file), name, scene.warnings);
    folder_.budget().give_back((lines - std::min(lines, found.size())) * sizeof(Found));
    for (MtlMaterial& m : found) {
      std::string key = m.name;
      materials_.try_emplace(std::move(key), Found{std::move(m), within});
    }
  }

  ObjFolder& folder_;
  std::size_t missing_ = 0, undefined_ = 0;
  std::unordered_map<std::string, Found> materials_;
  std::unordered_set<std::string> statements_, opened_;
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

/// What names and materials take, of which a hostile file has one for every face. A name is kept twice, once in a
/// table.
void count_names(const ObjLayout& layout, ImportBudget& budget) {
  constexpr std::size_t name = 2 * sizeof(std::string) + 64;
  budget.take(layout.runs.size() * sizeof(ObjRun) + layout.objects.size() * name +
              layout.materials.size() * (name + sizeof(Material)));
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
  count_names(layout, budget);
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
  libraries.report_rest();
  return scene;
}

}  // namespace zoneplate
