// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// An instance of a stream's scene, whose triangles follow those of the instance before.
struct StreamInstance {
  std::size_t end = 0;           ///< the number of the triangle after its last one
  float4x4 world_from_object{};  ///< that of Instance
};

/// Calls body(instance, begin, end) for the triangles [begin, end) that each instance has of [first, last).
template <class Body>
void for_each_instance(std::span<const StreamInstance> instances, std::size_t first, std::size_t last,
                       const Body& body) {
  const auto ends_after = [](std::size_t triangle, const StreamInstance& instance) { return triangle < instance.end; };
  auto at = std::upper_bound(instances.begin(), instances.end(), first, ends_after);
  for (std::size_t begin = first; begin < last; ++at) {
    const std::size_t end = std::min(last, at->end);
    if (begin < end) body(static_cast<std::size_t>(at - instances.begin()), begin, end);
    begin = end;
  }
}

/// The triangles of a file that need not fit into memory, in the coordinates of their meshes, read in any order and any
/// number of times.
class TriangleStream {
 public:
  virtual ~TriangleStream() = default;

  /// The number of triangles.
  virtual std::size_t count() const = 0;
  /// The instances, in the order of those of `head`: all triangles are of one, in the coordinates of the world, or of
  /// these.
  virtual std::vector<StreamInstance> instances() const { return {{count(), {}}}; }

  /// Writes the corners of the triangles [first, first + count), three each. Corners that the file lacks are not
  /// finite. Several threads may call it.
  virtual void read(std::size_t first, std::size_t count, float3* corners) const = 0;

  /// Takes note of triangles whose attributes decide on those of others. Several threads may call it.
  ///
  /// Requires  each triangle is examined once, before `head` and `mesh`; `corners` are those that `read` gives.
  virtual void examine(std::size_t first, std::size_t count, const float3* corners) = 0;

  /// Lets the system begin to load the triangles [first, first + count).
  virtual void read_ahead(std::size_t first, std::size_t count) const = 0;
  /// Lets the system reclaim the memory of what has been read.
  virtual void forget() const = 0;

  /// The scene that load_scene gives, without its vertices and triangles.
  ///
  /// Requires  every triangle has been examined, and is finite.
  virtual Scene head() const = 0;

  /// The mesh of these triangles of one instance, in ascending order, with the attributes that they have in that of
  /// load_scene, to the bit. Each corner has its own vertex.
  ///
  /// Requires  as `head`.
  virtual Mesh mesh(std::span<const std::uint32_t> triangles) const = 0;
};

}  // namespace zoneplate
