// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/nodes.h"

#include <limits>
#include <numeric>
#include <string>

#include "zoneplate/formats/gltf/accessor.h"

namespace zoneplate {
namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

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
    float4x4 world_from_parent;
    bool is_visible;
  };
  std::vector<Pending> pending;
  const auto push = [&](const std::vector<std::size_t>& numbers, int depth, const float4x4& world_from_parent,
                        bool is_visible) {
    for (std::size_t i = numbers.size(); i-- > 0;)
      pending.push_back({numbers[i], depth, world_from_parent, is_visible});
  };
  push(roots(choice.scene), 1, {}, true);
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
    nodes_.push_back({next.number, json,
                      next.world_from_parent * read_transform(json, pose == poses_.end() ? nullptr : &pose->second),
                      next.is_visible && (!visibility || visibility->flag("visible", true))});
    push(json.indices("children", place_.size()), next.depth + 1, nodes_.back().world_from_node,
         nodes_.back().is_visible);
  }
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
    if (place_[numbers[j]] == none)
      file_.warn(skin.place() + ": joint " + std::to_string(numbers[j]) + " is not in the scene, taken at the origin");
    else
      out[j] = nodes_[place_[numbers[j]]].world_from_node * out[j];
  }
  return out;
}

}  // namespace zoneplate
