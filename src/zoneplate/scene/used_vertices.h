// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The vertices of a scene's meshes that primitives use. A mesh is analysed at its first query.
///
/// Requires  the scene outlives this object, unchanged.
class UsedVertices {
 public:
  explicit UsedVertices(const Scene& scene)
      : scene_(scene), is_used_(scene.meshes.size()), local_(scene.meshes.size()) {}

  /// For each vertex of a mesh, 1 if it is used, else 0.
  std::span<const std::uint8_t> of(int mesh);

  /// The bounds of the used vertices of all instances in the world.
  Box bounds();

  /// The instances, in order, that may have a vertex with the greatest dot(axis, transform_point(world_from_object,
  /// position)) for one of the axes. An omitted instance has a smaller extent along all axes, or is the same as the
  /// previous one.
  ///
  /// Cost      linear in instances and in the vertices of meshes, and of one instance per axis.
  std::vector<std::size_t> reaching(std::span<const float3> axes);

  /// The greatest dot(axis, transform_point(world_from_object, position)) of the used vertices of an instance; minus
  /// infinity without any.
  float reach(const Instance& instance, float3 axis);

 private:
  Box bounds(const Instance& instance);
  const Box& local(int mesh);
  std::vector<std::size_t> farthest_by_box(std::span<const float3> axes) const;

  const Scene& scene_;
  std::vector<std::vector<std::uint8_t>> is_used_;
  std::vector<std::optional<Box>> local_;  ///< the bounds of each mesh in its own space
};

}  // namespace zoneplate
