// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/formats/ply/rows.h"
#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// Reads the vertices of a PLY file as a mesh without indices: positions and the other attributes that are present.
///
/// Colours are sRGB codes: integers over their whole range, floats in [0, 1]. The origin of texture coordinates in the
/// file is at the bottom left.
/// Errors    ErrorKind::Input: no x, y or z, or more vertices than 32-bit indices can address.
Mesh read_ply_vertices(const PlyRows& rows, ImportBudget& budget);

/// The triangles of a PLY file's faces.
struct PlyFaces {
  std::vector<std::uint32_t> index;
  std::vector<float2> corner_uv;     ///< one per index, if faces have their own texture coordinates
  std::vector<float4> corner_color;  ///< one per index, if faces have colours
  std::uint64_t too_short = 0, too_concave = 0;
};

/// Whether all faces are triangles of 32-bit indices in native byte order without other attributes, as in most files.
bool are_plain_triangles(const PlyRows& faces);

/// Reads the indices of such faces on a fast path; empty if one refers to a vertex that does not exist.
///
/// Cost      12 bytes per face, which the caller charges to the budget.
std::vector<std::uint32_t> read_plain_triangles(const PlyRows& faces, std::size_t vertices);

/// Reads faces of any kind and triangulates them.
///
/// Errors    ErrorKind::Input naming the first face with the index of a vertex that does not exist.
PlyFaces read_ply_faces(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget);

/// Reads the triangles of strips: a negative index ends a strip.
std::vector<std::uint32_t> read_ply_strips(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget);

/// Reads the lines of edges, two indices each.
std::vector<std::uint32_t> read_ply_edges(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget);

}  // namespace zoneplate
