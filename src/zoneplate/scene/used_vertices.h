#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Which vertices of a scene's meshes a primitive uses. A mesh is looked through when it is first asked about.
///
/// Requires  the scene outlives it, unchanged.
class UsedVertices {
 public:
  explicit UsedVertices(const Scene& scene) : scene_(scene), is_used_(scene.meshes.size()) {}

  /// 1 for each vertex of a mesh that is used, else 0.
  std::span<const std::uint8_t> of(int mesh);

  /// The bounds of the used vertices of all instances in the world.
  Box bounds();

 private:
  Box bounds(const Instance& instance);

  const Scene& scene_;
  std::vector<std::vector<std::uint8_t>> is_used_;
};

}  // namespace zoneplate
