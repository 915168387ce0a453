// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// Vertices begin, begin + 1, ... of some thread.
struct VertexRange {
  std::uint32_t begin = 0, size = 0;
};

/// Accumulation of smooth normals over many triangles, in floats.
///
/// A triangle adds to the normal at a corner its own times the sine of the angle there over the product of the two
/// edges' lengths: the cross product of any two edges over the squares of these two. What floats hold badly adds no
/// number: edges shorter than 1e-9 or longer than 1e9, and triangles whose height is less than a thousandth of an edge.
///
/// Shape     positions and normals are three floats a vertex, indices three a triangle.
/// Requires  every index below `vertices`, all positions finite.
struct SmoothSumKernels : PerIsa<SmoothSumKernels> {
  /// Adds the triangles, one after the other, to those of their vertices that lie in the range.
  void (*add)(const float* position, std::size_t vertices, const std::uint32_t* index, std::size_t triangles,
              VertexRange own, float* sum);
  /// Normalises sums, from the first on; a sum that is too inaccurate becomes (0, 1, 0) and is marked.
  void (*normalize)(float* sum, std::size_t count, char* mark);
  /// Marks vertices with a triangle that bends away from their normal by 25° or more, or that has no area. A mark may
  /// be set by several threads at once.
  void (*mark_turns)(const float* position, const float* normal, std::size_t vertices, const std::uint32_t* index,
                     std::size_t triangles, char* mark);

  static constexpr float least_square = 1e-36f, greatest_square = 1e36f;  ///< of products of two squared edges
  static constexpr float thin = 1e-6f;                                    ///< square of a height over that of an edge
  static constexpr float cos_25_squared = 0.82139381f;
};

}  // namespace zoneplate
