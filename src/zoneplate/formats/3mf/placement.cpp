// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/3mf/placement.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/3mf/package.h"

namespace zoneplate {
namespace {

using namespace model_3mf;

bool is_finite(const float4x4& m) {
  return std::all_of(m.column.begin(), m.column.end(),
                     [](const float4& c) { return is_finite(xyz(c)) && std::isfinite(c.w); });
}

}  // namespace

std::vector<Placement> top_objects(const Model& model, ImportBudget& budget) {
  std::set<std::uint32_t> inner;
  for (const auto& [id, object] : model.objects)
    for (const Placement& component : object.components)
      if (component.path.empty() && inner.insert(component.object).second) budget.take(64);
  std::vector<Placement> items;
  for (const auto& [id, object] : model.objects)
    if (!inner.contains(id)) append_charged(items, Placement{id, "", {}}, budget);
  return items;
}

void ObjectPlacer::place_all(Model& root, const std::vector<Placement>& items) {
  for (const Placement& item : items) place(root, item, {}, 0);
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

/// Whether there is a triangle in an object or its components. Those that contain themselves are looked for, too.
bool ObjectPlacer::has_triangles(Model& model, Object& object, int depth) {
  const auto [entry, is_new] = contents_.try_emplace(&object, Content::Open);
  if (!is_new) return entry->second == Content::Triangles;
  check_depth(object, depth);
  budget_.take(64);
  budget_.check_time();
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

void ObjectPlacer::place(Model& from, const Placement& placement, const float4x4& world_from_parent, int depth) {
  const Target target = find_target(from, placement);
  if (target.object == nullptr) return;
  Object& object = *target.object;
  check_depth(object, depth);
  if (depth == 0 && !has_triangles(*target.model, object, 0)) return;
  if (object.is_other && object.components.empty()) {
    flaws_.add(Flaw::Build, [&] {
      return fmt::format("{} is of the type \"other\", which is not built: it is left out", object.name);
    });
    return;
  }
  const float4x4 world = world_from_parent * placement.to_from_object;
  add_instances(*target.model, object, world);
  for (const Placement& component : object.components) place(*target.model, component, world, depth + 1);
}

void ObjectPlacer::add_instances(const Model& model, Object& object, const float4x4& world) {
  budget_.check_time();
  const std::vector<int>& meshes = meshes_.meshes_of(model, object);
  if (meshes.empty()) return;
  if (!is_finite(world))
    return flaws_.add(Flaw::Transform,
                      [&] { return fmt::format("{}: its transforms overflow: it is left out", object.name); });
  budget_.take(meshes.size() * 2 * sizeof(Instance) + 2 * sizeof(std::uint32_t));
  const auto number = static_cast<int>(scene_.objects.size());
  const auto [first, is_new] = names_.try_emplace(&object, scene_.objects.size());
  if (is_new)
    budget_.take(object.name.size() + 128), scene_.objects.push_back(object.name);
  else
    scene_.objects.share(first->second);
  for (std::size_t part = 0; part < meshes.size(); ++part)
    scene_.instances.push_back({meshes[part], number, world, static_cast<int>(part)});
}

}  // namespace zoneplate
