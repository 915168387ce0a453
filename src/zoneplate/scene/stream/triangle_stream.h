// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The triangles of a file that need not fit into memory: one opaque mesh, in the coordinates of its file, whose
/// triangles are read in any order and any number of times.
class TriangleStream {
 public:
  virtual ~TriangleStream() = default;

  /// The number of triangles.
  virtual std::size_t count() const = 0;

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

  /// The mesh of these triangles, in ascending order, with the attributes that they have in that of load_scene, to the
  /// bit. Each corner has its own vertex.
  ///
  /// Requires  as `head`.
  virtual Mesh mesh(std::span<const std::uint32_t> triangles) const = 0;
};

}  // namespace zoneplate
