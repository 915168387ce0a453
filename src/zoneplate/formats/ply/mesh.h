// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/formats/ply/rows.h"
#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// The vertices of a PLY file as a mesh without indices: positions, and what else they have.
///
/// Colours are sRGB codes, of integers over their whole range and floats in [0, 1]; texture coordinates have their
/// origin at the bottom left in the file.
/// Errors    ErrorKind::Input: no x, y or z, more vertices than 32-bit indices can name.
Mesh read_ply_vertices(const PlyRows& rows, ImportBudget& budget);

/// The triangles of a PLY file's faces.
struct PlyFaces {
  std::vector<std::uint32_t> index;
  std::vector<float2> corner_uv;     ///< for each index, where faces have texture coordinates of their own
  std::vector<float4> corner_color;  ///< likewise, where faces have colours
  std::uint64_t too_short = 0, too_concave = 0;
};

/// Whether the faces are nothing but triangles of 32-bit indices in this machine's order, as most files have them.
bool are_plain_triangles(const PlyRows& faces);

/// The indices of such faces, at full speed; none where one names a vertex that is not there.
///
/// Cost      12 bytes a face, for the caller to take of the budget.
std::vector<std::uint32_t> read_plain_triangles(const PlyRows& faces, std::size_t vertices);

/// Cuts the faces into triangles, whatever they are.
///
/// Errors    ErrorKind::Input naming the first face that uses a vertex which is not there.
PlyFaces read_ply_faces(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget);

/// The triangles of strips: an index below 0 ends one.
std::vector<std::uint32_t> read_ply_strips(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget);

/// The lines of edges, two indices each.
std::vector<std::uint32_t> read_ply_edges(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget);

}  // namespace zoneplate
