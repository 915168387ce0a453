// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/3mf/placement.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/3mf/package.h"
#include "zoneplate/scene/geometry/origin.h"

namespace zoneplate {
namespace {

using namespace model_3mf;

bool is_finite(const float4x4& m) {
  return std::all_of(m.column.begin(), m.column.end(),
                     [](const float4& c) { return is_finite(xyz(c)) && std::isfinite(c.w); });
}

/// Visits objects of one model with all that they contain, depth first, each once.
class ComponentWalk {
 public:
  struct Step {
    std::uint32_t id;
    const Object* object;
    std::size_t next = 0;  ///< the number of the next component
  };

  ComponentWalk(const Model& model, const ImportBudget& budget) : model_(model), budget_(budget) {}

  /// Returns false if the object has been visited; otherwise calls `end(id)` for each object after what it contains.
  template <class End>
  bool walk(std::uint32_t id, const End& end) {
    if (!enter(id)) return false;
    budget_.check_time();
    while (!open_.empty()) {
      Step& step = open_.back();
      if (step.next < step.object->components.size()) {
        const Placement& component = step.object->components[step.next++];
        if (component.path.empty()) enter(component.object);
      } else {
        end(step.id);
        open_.pop_back();
      }
    }
    return true;
  }

 private:
  bool enter(std::uint32_t id) {
    const auto found = model_.objects.find(id);
    if (found == model_.objects.end() || !seen_.insert(id).second) return false;
    open_.push_back({id, &found->second});
    return true;
  }

  const Model& model_;
  const ImportBudget& budget_;
  std::vector<Step> open_;
  std::set<std::uint32_t> seen_;
};

}  // namespace

std::vector<Placement> top_objects(const Model& model, ImportBudget& budget) {
  budget.take(model.objects.size() * (2 * sizeof(ComponentWalk::Step) + 3 * sizeof(std::uint32_t) + 128));
  std::vector<std::uint32_t> ended, tops;
  ComponentWalk all(model, budget);
  for (const auto& [id, object] : model.objects) all.walk(id, [&](std::uint32_t end) { ended.push_back(end); });
  // No object that is not yet walked from contains the last one that ended, unless that contains it, too.
  ComponentWalk rest(model, budget);
  for (auto id = ended.rbegin(); id != ended.rend(); ++id)
    if (rest.walk(*id, [](std::uint32_t) {})) tops.push_back(*id);
  std::sort(tops.begin(), tops.end());
  std::vector<Placement> items;
  for (const std::uint32_t id : tops) append_charged(items, Placement{id, "", {}}, budget);
  return items;
}

void ObjectPlacer::place_all(Model& root, const std::vector<Placement>& items) {
  for (const Placement& item : items) place(root, item, {}, 0);
  center_far_scene(scene_, placed_);
}

ObjectPlacer::Target ObjectPlacer::find_target(Model& from, const Placement& placement) {
  const std::string part = placement.path.empty() ? from.part : part_name(placement.path);
  Model* const model = find_model_(part);
  if (model != nullptr) {
    const auto found = model->objects.find(placement.object);
    if (found != model->objects.end()) return {model, &found->second};
  }
  flaws_.add(Flaw::Reference, [&] {
    return model == nullptr ? fmt::format("model {} is not in the package: its objects are left out", part)
                            : fmt::format("object {} is not {}: it is left out", placement.object,
                                          part.empty() ? "there" : "in " + part);
  });
  return {};
}

/// Whether there is a triangle to be built in an object or its components. What is not built, and those that contain
/// themselves, are left out, once for each object.
bool ObjectPlacer::has_triangles(Model& model, Object& object, int depth) {
  const auto [entry, is_new] = contents_.try_emplace(&object, Content::Open);
  if (!is_new) return entry->second == Content::Triangles;
  check_depth(object, depth);
  budget_.take(64);
  budget_.check_time();
  if (object.is_other && !object.triangles.empty()) {
    flaws_.add(Flaw::Build, [&] {
      return fmt::format("{} is of the type \"other\", which is not built: it is left out", object.name);
    });
    object.triangles.clear();
  }
  bool has_any = !object.triangles.empty();
  std::vector<Placement> kept;
  for (Placement& component : object.components) {
    const Target target = find_target(model, component);
    if (target.object == nullptr) continue;
    const auto known = contents_.find(target.object);
    if (known != contents_.end() && known->second == Content::Open) {
      flaws_.add(Flaw::Cycle,
                 [&] { return fmt::format("{} contains itself: the component is left out", target.object->name); });
      continue;
    }
    if (!has_triangles(*target.model, *target.object, depth + 1)) continue;
    has_any = true;
    kept.push_back(std::move(component));
  }
  object.components = std::move(kept);
  contents_[&object] = has_any ? Content::Triangles : Content::Nothing;
  return has_any;
}

void ObjectPlacer::check_depth(const Object& object, int depth) const {
  if (depth > budget_.limits().node_depth)
    throw Error(ErrorKind::Input, fmt::format("{}: {}: components deeper than {}", budget_.file(),
                                              printable(object.name), budget_.limits().node_depth));
}

void ObjectPlacer::place(Model& from, const Placement& placement, const World& parent, int depth) {
  const Target target = find_target(from, placement);
  if (target.object == nullptr) return;
  Object& object = *target.object;
  check_depth(object, depth);
  if (depth == 0 && !has_triangles(*target.model, object, 0)) return;
  const World world{parent.from_object * narrowed(placement.to_from_object, {}),
                    parent.from_object_far * placement.to_from_object};
  add_instances(*target.model, object, world);
  for (const Placement& component : object.components) place(*target.model, component, world, depth + 1);
}

void ObjectPlacer::add_instances(const Model& model, Object& object, const World& world) {
  budget_.check_time();
  const std::vector<int>& meshes = meshes_.meshes_of(model, object);
  if (meshes.empty()) return;
  Affine placed = world.from_object_far;
  placed.move = transform_point(placed, object.centre);
  const bool is_centred = object.centre != double3{};
  const float4x4 world_from_object = is_centred ? narrowed(placed, {}) : world.from_object;
  if (!is_finite(world_from_object))
    return flaws_.add(Flaw::Transform,
                      [&] { return fmt::format("{}: its transforms overflow: it is left out", object.name); });
  budget_.take(meshes.size() * 2 * (sizeof(Instance) + sizeof(Affine)) + 2 * sizeof(std::uint32_t));
  const auto number = static_cast<int>(scene_.objects.size());
  const auto [first, is_new] = names_.try_emplace(&object, scene_.objects.size());
  if (is_new)
    budget_.take(object.name.size() + 128), scene_.objects.push_back(object.name);
  else
    scene_.objects.share(first->second);
  for (std::size_t part = 0; part < meshes.size(); ++part) {
    scene_.instances.push_back({meshes[part], number, world_from_object, static_cast<int>(part)});
    placed_.push_back(placed);
  }
}

}  // namespace zoneplate
