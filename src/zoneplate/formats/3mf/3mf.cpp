// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/3mf/3mf.h"

#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/3mf/flaws.h"
#include "zoneplate/formats/3mf/model.h"
#include "zoneplate/formats/3mf/package.h"
#include "zoneplate/formats/3mf/placement.h"
#include "zoneplate/formats/xml/xml.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

using namespace model_3mf;

/// The state of one import.
class Import {
 public:
  Import(std::span<const std::uint8_t> bytes, ImportBudget& budget, Scene& scene)
      : budget_(budget), scene_(scene), flaws_(budget, scene.warnings), package_(bytes, budget) {}

  void run() {
    Model* const model = find_model(root_part());
    if (model == nullptr) throw Error(ErrorKind::Input, budget_.file() + ": has no 3MF model");
    ModelFolder files("", budget_, scene_);
    const auto contents = [&](const std::string& part) -> std::optional<std::vector<std::uint8_t>> {
      const auto number = package_.find(part);
      return number ? std::optional(package_.contents(*number)) : std::nullopt;
    };
    ObjectPlacer placer([&](const std::string& part) { return find_model(part); }, contents, files, flaws_);
    placer.place_all(*model, items_of(*model));
    flaws_.report();
  }

 private:
  std::string root_part() {
    std::string part = package_.target_of_type("http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel");
    if (!part.empty() && package_.find(part)) return part;
    const std::string other = package_.find_ending(".model");
    if (!other.empty())
      flaws_.add(Flaw::Relationship,
                 [&] { return "its relationships name no model that is there: " + other + " is drawn"; });
    return other;
  }

  /// The model of a part, which is parsed at its first use; null, with a flaw, if there is no such part.
  Model* find_model(const std::string& part) {
    const auto known = models_.find(part);
    if (known != models_.end()) return known->second.get();
    budget_.take(part.size() + 128);
    const auto entry = models_.try_emplace(part).first;
    const auto number = package_.find(part);
    if (part.empty() || !number) return nullptr;
    auto model = std::make_unique<Model>();
    model->part = part;
    ModelParser3mf handler(*model, flaws_, budget_);
    XmlParser parser(handler, budget_.file() + ": " + printable(package_.name(*number)), budget_);
    const bool is_intact = package_.read(*number, [&](std::span<const std::uint8_t> piece) { parser.feed(piece); });
    parser.finish();
    handler.finish();
    if (!is_intact) flaws_.add(Flaw::Checksum, [&] { return package_.name(*number) + ": its checksum is wrong"; });
    entry->second = std::move(model);
    return entry->second.get();
  }

  /// The items of the build; without a build, the objects that are no components.
  std::vector<Placement> items_of(Model& model) {
    if (!model.items.empty()) return std::move(model.items);
    std::vector<Placement> items = top_objects(model, budget_);
    if (!items.empty())
      flaws_.add(Flaw::Build, [] { return "its build has no items: the objects that are no components are drawn"; });
    return items;
  }

  ImportBudget& budget_;
  Scene& scene_;
  FlawList flaws_;
  Package package_;
  std::map<std::string, std::unique_ptr<Model>> models_;  ///< by part
};

}  // namespace

Scene load_3mf(const std::string& path, const LoadLimits& limits) {
  const FileBytes file(path, limits.memory);
  ImportBudget budget(path == "-" ? "standard input" : path, limits);
  Scene scene;
  scene.up = {0, 0, 1};
  if (!is_zip(file.bytes())) throw Error(ErrorKind::Input, budget.file() + ": is no 3MF package: no ZIP archive");
  Import(file.bytes(), budget, scene).run();
  if (scene.instances.empty()) throw budget.nothing_to_draw(scene.warnings, "holds nothing to draw");
  return scene;
}

}  // namespace zoneplate
