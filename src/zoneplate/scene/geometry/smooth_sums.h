// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The vertices [begin, begin + size), which one thread processes.
struct VertexRange {
  std::uint32_t begin = 0, size = 0;
};

/// Accumulation of smooth normals over many triangles, in floats.
///
/// A triangle's contribution to the normal of a corner is its unit normal times the sine of the corner's angle over the
/// product of the two edges' lengths: the cross product of any two edges over the squares of these two. Contributions
/// that floats represent inaccurately are NaN: those of edges shorter than 1e-9 or longer than 1e9, and of triangles
/// whose height is less than a thousandth of an edge.
///
/// Shape     positions and normals are three floats per vertex, indices three per triangle.
/// Requires  every index is below `vertices`, all positions are finite.
struct SmoothSumKernels : PerIsa<SmoothSumKernels> {
  /// Adds the contributions of the triangles, in order, to those of their vertices that are in the range.
  void (*add)(const float* position, std::size_t vertices, const std::uint32_t* index, std::size_t triangles,
              VertexRange own, float* sum);
  /// Normalizes the first `count` sums; a sum that is too inaccurate becomes (0, 1, 0) and is marked.
  void (*normalize)(float* sum, std::size_t count, char* mark);
  /// Marks vertices with a triangle whose normal deviates from theirs by 25° or more, or that has no area. Several
  /// threads may set a mark at once.
  void (*mark_turns)(const float* position, const float* normal, std::size_t vertices, const std::uint32_t* index,
                     std::size_t triangles, char* mark);

  static constexpr float min_square = 1e-36f, max_square = 1e36f;  ///< limits of products of two squared edges
  /// Square of the ratio of a height to an edge.
  static constexpr float thin = 1e-6f;
  static constexpr float cos_25_squared = 0.82139381f;
};

}  // namespace zoneplate
