// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/libraries.h"

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/formats/import/text_scan.h"
#include "zoneplate/formats/obj/mtl_material.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

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
        parse_mtl({reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()}, name, scene.warnings,
                  [&](const std::string& m) { return is_used(m); });
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

}  // namespace

void add_obj_materials(const ObjLayout& layout, ModelFolder& folder) {
  Libraries libraries(folder, layout.materials);
  for (const std::string& statement : layout.libraries) libraries.add(statement);
  for (const std::string& material : layout.materials) {
    folder.budget().check_time();
    folder.scene().materials.push_back(libraries.material(material));
  }
  libraries.report_rest();
}

}  // namespace zoneplate
