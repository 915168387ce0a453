// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/nodes.h"

#include <map>
#include <numeric>
#include <string>

#include "zoneplate/formats/gltf/accessor.h"
#include "zoneplate/math/box.h"
#include "zoneplate/scene/geometry/origin.h"

namespace zoneplate {
namespace {

float4x4 read_transform(const JsonView& json, const GltfNodePose* pose) {
  if (const std::vector<float> m = json.numbers("matrix", 16); !m.empty())
    return {{float4{m[0], m[1], m[2], m[3]}, float4{m[4], m[5], m[6], m[7]}, float4{m[8], m[9], m[10], m[11]},
             float4{m[12], m[13], m[14], m[15]}}};
  std::vector<float> t = json.numbers("translation", 3), r = json.numbers("rotation", 4), s = json.numbers("scale", 3);
  if (pose && pose->translation) t = {pose->translation->x, pose->translation->y, pose->translation->z};
  if (pose && pose->rotation) r = {pose->rotation->x, pose->rotation->y, pose->rotation->z, pose->rotation->w};
  if (pose && pose->scale) s = {pose->scale->x, pose->scale->y, pose->scale->z};
  float4x4 out = t.empty() ? float4x4{} : translation({t[0], t[1], t[2]});
  if (!r.empty()) out = out * rotation(Quaternion{r[0], r[1], r[2], r[3]});
  if (!s.empty()) out = out * scaling({s[0], s[1], s[2]});
  return out;
}

/// The same transform in doubles, as the JSON has them.
Affine read_placement(const JsonView& json, const GltfNodePose* pose) {
  if (const std::vector<double> m = json.doubles("matrix", 16); !m.empty())
    return {{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
  std::vector<double> t = json.doubles("translation", 3), r = json.doubles("rotation", 4), s = json.doubles("scale", 3);
  if (pose && pose->translation) t = {pose->translation->x, pose->translation->y, pose->translation->z};
  if (pose && pose->rotation) r = {pose->rotation->x, pose->rotation->y, pose->rotation->z, pose->rotation->w};
  if (pose && pose->scale) s = {pose->scale->x, pose->scale->y, pose->scale->z};
  Affine out;
  if (!t.empty()) out.move = {t[0], t[1], t[2]};
  if (!r.empty()) out = out * rotation(r[0], r[1], r[2], r[3]);
  if (!s.empty()) out = out * Affine{{s[0], 0, 0}, {0, s[1], 0}, {0, 0, s[2]}, {}};
  return out;
}

/// Throws for an index out of range; the message states the number of elements.
void check_number(const std::optional<int>& number, std::size_t count, const char* what, const char* option) {
  if (!number || (*number >= 0 && static_cast<std::size_t>(*number) < count)) return;
  throw Error(ErrorKind::Usage, std::string(option) + ": the file has " +
                                    (count == 0 ? std::string("no ") + what
                                                : std::string(what) + "s 0 to " + std::to_string(count - 1) + ", not " +
                                                      std::to_string(*number)));
}

/// The index of the first animation of this name.
int find_animation(GltfFile& file, const std::string& name) {
  std::string names;
  for (std::size_t i = 0; i < file.count("animations"); ++i) {
    file.budget().check_time();
    const std::string own = file.root().element("animations", i, "animation").text("name");
    if (own == name) return static_cast<int>(i);
    if (!own.empty() && names.size() < 200) names += (names.empty() ? "" : ", ") + quoted(own);
  }
  throw Error(ErrorKind::Usage, "--animation-index: the file has no animation " + quoted(name) +
                                    (names.empty() ? "" : "; it has " + names));
}

}  // namespace

std::vector<std::size_t> chosen_animations(GltfFile& file, const SceneChoice& choice) {
  const std::size_t count = file.count("animations");
  const std::optional<int> one =
      choice.animation_name.empty() ? choice.animation : find_animation(file, choice.animation_name);
  if (!one) return {};
  if (*one != SceneChoice::all_animations || count == 0) {
    check_number(one, count, "animation", "--animation-index");
    return {static_cast<std::size_t>(*one)};
  }
  std::vector<std::size_t> all(count);
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<std::size_t> GltfNodes::roots(const std::optional<int>& chosen) const {
  const std::size_t count = file_.count("nodes");
  if (chosen) return file_.root().element("scenes", static_cast<std::size_t>(*chosen), "scene").indices("nodes", count);
  if (const auto scene = file_.root().find_index("scene", file_.count("scenes")))
    return file_.root().element("scenes", *scene, "scene").indices("nodes", count);
  if (file_.count("scenes") > 0) return file_.root().element("scenes", 0, "scene").indices("nodes", count);
  std::vector<bool> is_child(count);
  for (std::size_t i = 0; i < count; ++i) {
    file_.budget().check_time();
    for (const std::size_t c : file_.root().element("nodes", i, "node").indices("children", count)) is_child[c] = true;
  }
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < count; ++i)
    if (!is_child[i]) out.push_back(i);
  return out;
}

GltfNodes::GltfNodes(GltfFile& file, const SceneChoice& choice) : file_(file), place_(file.count("nodes"), none) {
  check_number(choice.scene, file.count("scenes"), "scene", "--scene");
  for (const std::size_t i : chosen_animations(file, choice)) animate(file, i, choice.time, poses_);
  struct Pending {
    std::size_t number;
    int depth;
    std::size_t parent;
    float4x4 world_from_parent;
    bool is_visible;
  };
  std::vector<Pending> pending;
  const auto push = [&](const std::vector<std::size_t>& numbers, Pending parent) {
    for (std::size_t i = numbers.size(); i-- > 0;) {
      parent.number = numbers[i];
      pending.push_back(parent);
    }
  };
  push(roots(choice.scene), {none, 1, none, {}, true});
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    const JsonView json = file.root().element("nodes", next.number, "node");
    if (place_[next.number] != none) json.fail("is reached twice, a node may have one parent only");
    if (next.depth > file.budget().limits().node_depth)
      json.fail("lies deeper than the limit of " + std::to_string(file.budget().limits().node_depth) + " nodes");
    file.budget().check_time();
    file.budget().take(2 * sizeof(GltfNode) + json.place().size());
    place_[next.number] = nodes_.size();
    const auto pose = poses_.find(next.number);
    const auto visibility = json.extension("KHR_node_visibility");
    nodes_.push_back({next.number, json, next.parent,
                      next.world_from_parent * read_transform(json, pose == poses_.end() ? nullptr : &pose->second),
                      next.is_visible && (!visibility || visibility->flag("visible", true))});
    push(json.indices("children", place_.size()),
         {none, next.depth + 1, nodes_.size() - 1, nodes_.back().world_from_node, nodes_.back().is_visible});
  }
}

void GltfNodes::set_origin(double3 origin) {
  file_.budget().take(nodes_.size() * sizeof(Affine));
  origin_ = origin;
  placed_.reserve(nodes_.size());
  for (GltfNode& node : nodes_) {
    const auto pose = poses_.find(node.number);
    const Affine local = read_placement(node.json, pose == poses_.end() ? nullptr : &pose->second);
    placed_.push_back(node.parent == none ? local : placed_[node.parent] * local);
    node.world_from_node = narrowed(placed_.back(), origin);
  }
}

float4x4 GltfNodes::place(const GltfNode& node, const float4x4& local, double3 centre) const {
  const Affine moved = widened(local) * Affine{.move = centre};
  return narrowed(placed_[place_[node.number]] * moved, origin_);
}

std::vector<float> GltfNodes::weights(const GltfNode& node) const {
  const auto pose = poses_.find(node.number);
  if (pose != poses_.end() && !pose->second.weights.empty()) return pose->second.weights;
  return node.json.numbers("weights", 0);
}

std::vector<float4x4> GltfNodes::joints(const GltfNode& node) const {
  const JsonView skin = file_.root().element("skins", node.json.index("skin", file_.count("skins")), "skin");
  const std::vector<std::size_t> numbers = skin.indices("joints", place_.size());
  if (numbers.empty()) skin.fail("has no joints");
  std::vector<float4x4> out;
  if (skin.has("inverseBindMatrices")) out = read_float4x4(file_, skin, "inverseBindMatrices");
  if (!out.empty() && out.size() < numbers.size())
    skin.fail("inverseBindMatrices has " + std::to_string(out.size()) + " elements, expected " +
              std::to_string(numbers.size()));
  out.resize(numbers.size());
  for (std::size_t j = 0; j < numbers.size(); ++j) {
    if (place_[numbers[j]] == none) {
      file_.warn(skin.place() + ": joint " + std::to_string(numbers[j]) + " is not in the scene, taken at the origin");
      if (is_far()) out[j] = narrowed(widened(out[j]), origin_);
    } else if (is_far()) {
      out[j] = place(nodes_[place_[numbers[j]]], out[j], {});
    } else {
      out[j] = nodes_[place_[numbers[j]]].world_from_node * out[j];
    }
  }
  return out;
}

namespace {

/// The value of a normalized integer's unit; 1 for other types.
float unit_of(const JsonView& accessor) {
  if (!accessor.flag("normalized", false)) return 1;
  switch (accessor.whole("componentType")) {
    case 5120:
      return 1.0f / 127;
    case 5121:
      return 1.0f / 255;
    case 5122:
      return 1.0f / 32767;
    default:
      return 1.0f / 65535;
  }
}

/// The bounds that a mesh's accessors state.
Box stated_bounds(GltfFile& file, const JsonView& mesh) {
  Box box;
  for (std::size_t i = 0; i < mesh.count("primitives"); ++i) {
    const JsonView attributes = mesh.element("primitives", i, "primitive").object("attributes");
    const auto number = attributes.find_index("POSITION", file.count("accessors"));
    if (!number) continue;
    const JsonView accessor = file.root().element("accessors", *number, "accessor");
    const float unit = unit_of(accessor);
    for (const char* end : {"min", "max"})
      if (const std::vector<float> p = accessor.numbers(end, 3); !p.empty()) box.add(float3{p[0], p[1], p[2]} * unit);
  }
  return box;
}

class OriginFinder {
 public:
  OriginFinder(GltfFile& file, const GltfNodes& nodes) : file_(file), nodes_(nodes) {}

  double3 find() {
    add_nodes([](const GltfNode& node) { return node.is_visible && !is_hidden(node.world_from_node); });
    if (choice_.is_empty()) add_nodes([](const GltfNode&) { return true; });  // an animation may show them later
    return choice_.origin();
  }

 private:
  template <class Counts>
  void add_nodes(const Counts& counts) {
    for (const GltfNode& node : nodes_.in_scene()) {
      if (choice_.is_near()) break;
      file_.budget().check_time();
      if (!counts(node)) continue;
      try {
        add(node);
      } catch (const Error&) {  // the reader of the invalid part reports it, if anything uses it
      }
    }
  }

  void add(const GltfNode& node) {
    const auto mesh = node.json.find_index("mesh", file_.count("meshes"));
    if (!mesh) return;
    if (node.json.has("skin")) return add_joints(node, bounds_of(*mesh));
    const auto instancing = node.json.extension("EXT_mesh_gpu_instancing");
    const JsonView places = instancing ? instancing->object("attributes") : node.json;
    if (!instancing || !places.has("TRANSLATION")) return add(bounds_of(*mesh), node, {});
    // All of many places are read only where the first one is far.
    for (const ElementRange range : {ElementRange{0, 1}, ElementRange{}}) {
      const std::vector<float3> some = read_float3(file_, places, "TRANSLATION", range);
      for (std::size_t i = 0; i < some.size() && !choice_.is_near(); ++i) add(bounds_of(*mesh), node, some[i]);
      file_.budget().give_back(some.size() * sizeof(float3));
      if (choice_.is_near()) return;
    }
  }

  void add(const Box& box, const GltfNode& node, float3 moved) {
    for (int i = 0; i < 8 && !box.empty(); ++i)
      choice_.add(transform_point(node.world_from_node, box.corner(i) + moved));
  }

  /// A skinned mesh lies around its joints, and is as large as without a pose.
  void add_joints(const GltfNode& node, const Box& box) {
    const JsonView skin = file_.root().element("skins", node.json.index("skin", file_.count("skins")), "skin");
    for (const std::size_t joint : skin.indices("joints", file_.count("nodes")))
      if (const GltfNode* const found = nodes_.find(joint); found != nullptr && !box.empty())
        for (const float3 corner : {box.low, box.high})
          choice_.add(xyz(found->world_from_node.column[3]) + (corner - box.centre()));
  }

  const Box& bounds_of(std::size_t mesh) {
    if (const auto found = bounds_.find(mesh); found != bounds_.end()) return found->second;
    return bounds_[mesh] = stated_bounds(file_, file_.root().element("meshes", mesh, "mesh"));
  }

  GltfFile& file_;
  const GltfNodes& nodes_;
  OriginChoice choice_;
  std::map<std::size_t, Box> bounds_;  ///< by mesh
};

}  // namespace

bool is_hidden(const float4x4& world_from_object) {
  const auto& axis = world_from_object.column;
  return xyz(axis[0]) == float3{} && xyz(axis[1]) == float3{} && xyz(axis[2]) == float3{};
}

double3 find_origin(GltfFile& file, const GltfNodes& nodes) { return OriginFinder(file, nodes).find(); }

}  // namespace zoneplate
