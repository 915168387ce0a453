// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "zoneplate/formats/gltf/animation.h"
#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/math/affine.h"
#include "zoneplate/math/transform.h"

namespace zoneplate {

/// The indices of the animations that a choice plays.
///
/// Errors    ErrorKind::Usage: an animation that the file does not have.
std::vector<std::size_t> chosen_animations(GltfFile& file, const SceneChoice& choice);

/// A node of the scene with its world transform.
struct GltfNode {
  std::size_t number;  ///< index in the file
  JsonView json;
  std::size_t parent;  ///< index in GltfNodes::in_scene, or GltfNodes::none
  float4x4 world_from_node;
  bool is_visible = true;  ///< and all its ancestors (KHR_node_visibility)
};

/// The nodes of one of a file's scenes, each after its parent, in depth-first order.
///
/// The scene is the chosen one, otherwise the file's default scene, otherwise its first one, otherwise all root nodes.
class GltfNodes {
 public:
  static constexpr std::size_t none = ~std::size_t{0};

  /// Errors    ErrorKind::Input: a node that is reached twice (including cycles), nesting beyond the limit, an invalid
  ///           index; ErrorKind::Usage: a scene or animation that the file does not have.
  explicit GltfNodes(GltfFile& file, const SceneChoice& choice = {});

  const std::vector<GltfNode>& in_scene() const { return nodes_; }
  /// The node of this index in the file; null if it is not in the scene.
  const GltfNode* find(std::size_t number) const { return place_[number] == none ? nullptr : &nodes_[place_[number]]; }

  /// Makes the world relative to an origin that is not 0. From then on all transforms are products of doubles, from
  /// which the origin is subtracted before they are rounded to floats.
  void set_origin(double3 origin);
  bool is_far() const { return !placed_.empty(); }

  /// The transform of something that `local` places relative to a node, and that is moved by `centre` before.
  float4x4 place(const GltfNode& node, const float4x4& local, double3 centre) const;

  /// The weights of the morph targets of the node's mesh, from the animation or else the node; empty: the mesh's own.
  std::vector<float> weights(const GltfNode& node) const;

  /// The transform world from mesh for each joint of the node's skin.
  std::vector<float4x4> joints(const GltfNode& node) const;

 private:
  std::vector<std::size_t> roots(const std::optional<int>& chosen) const;

  GltfFile& file_;
  GltfPoses poses_;
  std::vector<GltfNode> nodes_;
  /// For each of the file's nodes, its index in nodes_, or none if it is not in the scene.
  std::vector<std::size_t> place_;
  double3 origin_;
  std::vector<Affine> placed_;  ///< of nodes_, relative to the file's origin; empty unless is_far
};

/// Whether a transform has the scale 0, by which animations hide a node: its one point is not part of the bounds.
bool is_hidden(const float4x4& world_from_object);

/// Scene::origin of the nodes of a scene that are drawn, or of all if none is, as OriginChoice decides, from the bounds
/// that the file states for the positions of its meshes, and its joints. Meshes without bounds do not count; wrong
/// bounds cost precision only.
double3 find_origin(GltfFile& file, const GltfNodes& nodes);

}  // namespace zoneplate
