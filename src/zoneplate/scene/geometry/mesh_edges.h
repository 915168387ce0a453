// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// An edge of a triangle mesh with two of the triangles that have it.
struct MeshEdge {
  static constexpr std::uint32_t no_face = 0xffffffffu;

  std::uint32_t vertex[2];  ///< of the first face
  std::uint32_t face[2];    ///< triangles of the mesh; the second is `no_face` at a boundary
  bool is_turned = false;   ///< both faces have the edge in the same direction: they are oriented differently
  bool is_manifold = true;  ///< no further triangle has the edge
};

/// The edges of a mesh of triangles. Vertices of equal positions are one vertex, whatever their other attributes are;
/// triangles with two equal corners have no edges. An edge of n > 2 triangles is listed n - 1 times, with the first of
/// them and each of the others.
///
/// Exact     sorted by the vertices' first numbers; depends on the mesh only.
std::vector<MeshEdge> mesh_edges(const Mesh& mesh);

}  // namespace zoneplate
