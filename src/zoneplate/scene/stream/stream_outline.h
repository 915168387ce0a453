// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "zoneplate/scene/stream/triangle_stream.h"

namespace zoneplate {

/// Where the triangles of a stream lie: the bounds of blocks of them, by which few blocks have to be read again to find
/// the farthest corner in a direction.
class StreamOutline {
 public:
  static constexpr std::size_t block = std::size_t{1} << 11;  ///< triangles

  /// Reads and examines all triangles. `progress` takes the fraction that is read.
  ///
  /// Errors    ErrorKind::Input naming `file` where a corner is missing or not finite, or where the triangles lie so far
  ///           from the origin that Scene::origin would not be 0, or that a reader may drop them: such scenes have to
  ///           be in memory.
  StreamOutline(TriangleStream& stream, const std::string& file, const std::function<void(double)>& progress);

  const Box& bounds() const { return bounds_; }

  /// The farthest corners along each direction and along the axes, in the order of the triangles: of equal ones the
  /// first. As points of a scene they have the bounds of the whole, and its extent in these directions.
  std::vector<float3> farthest(std::span<const float3> directions) const;

  /// Whether one of the triangles faces a camera: sees_backs_alone of fit.h, of single-sided triangles.
  bool has_front(const Camera& camera) const;

 private:
  /// The corners of triangles in the world.
  void read(std::size_t first, std::size_t count, std::vector<float3>& corners) const;

  const TriangleStream& stream_;
  std::vector<StreamInstance> instances_;
  std::vector<Box> boxes_;  ///< by block
  Box bounds_;
};

}  // namespace zoneplate
