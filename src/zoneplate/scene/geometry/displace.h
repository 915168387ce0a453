// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// A height map over texture coordinates.
struct HeightMap {
  std::function<float(float2 uv)> height;  ///< in units of length along the normal; called on any thread
  float2 texels{1, 1};                     ///< the width and height of its texels' grid over uv in [0, 1]²
};

/// How finely a displaced surface is refined.
struct Refinement {
  float tolerance = 0;                    ///< greatest distance between the mesh and the height map, units of length
  std::size_t max_triangles = 4'000'000;  ///< refinement stops before it has more
};

/// The result of `displace`.
struct Displaced {
  Mesh mesh;
  bool is_complete = true;  ///< false: `max_triangles` ended the refinement before the tolerance was reached
};

/// Refines a triangle mesh where its height map has detail, and moves its vertices along their normals by the height.
///
/// In each pass an edge is halved where it spans more than 16 texels, or where the height map deviates from the
/// interpolated heights by more than the tolerance along the edge or, for the longest edge, within a triangle of it.
/// The decision belongs to the edge's position: triangles on both sides of a seam of normals or texture coordinates
/// halve it together. Where a triangle has an edge to be halved, its longest edge is halved too. Vertices of equal
/// position move by the mean of their heights along the mean of their normals. A closed mesh therefore stays closed, to
/// the bit.
///
/// Normals follow from the displaced triangles; they stay discontinuous where those of `mesh` are. Tangents are
/// dropped.
/// Requires  triangles with normals and uv0, all finite.
/// Exact     + - × / √ only, in an order that does not depend on the number of threads.
/// Errors    those of base/deadline.h.
/// Source    displacement: Cook, Shade Trees, SIGGRAPH 1984; refinement by longest edges: Rivara, Algorithms for
///           Refining Triangular Grids Suitable for Adaptive and Multigrid Techniques, IJNME 20, 1984.
Displaced displace(const Mesh& mesh, const HeightMap& map, const Refinement& refinement);

}  // namespace zoneplate
