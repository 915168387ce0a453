// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "zoneplate/formats/ply/rows.h"
#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// Whether the vertices are Gaussian splats: their colours are coefficients of spherical harmonics, f_dc_0 to f_dc_2.
bool are_splats(const PlyElement& vertices);

/// The unit vector along a normal of the file; zero for one without a direction.
float3 ply_normal(float3 stored);

/// A mesh without indices, and the Scene::origin that its positions are relative to.
struct PlyVertices {
  Mesh mesh;
  double3 origin;
};

/// The properties of vertices that are read; for positions, x, y and z.
struct PlyColumns {
  std::optional<std::array<std::size_t, 3>> position, normal, color;
  std::optional<std::array<std::size_t, 2>> uv;
  std::optional<std::size_t> alpha;
};
PlyColumns find_columns(const PlyElement& vertices);

/// Reads the vertices of a PLY file: positions and the other attributes that are present. `origin`: that of the whole
/// file, if these are some of its vertices.
///
/// Colours are sRGB codes: integers over their whole range, floats in [0, 1], or either in [0, 255] (one_of); those of
/// splats are that of their constant harmonic, and splats have no normals. The origin of texture coordinates in the
/// file is at the bottom left.
/// Errors    ErrorKind::Input: no x, y or z, or more vertices than 32-bit indices can address.
PlyVertices read_ply_vertices(const PlyRows& rows, ImportBudget& budget, std::optional<double3> origin = {});

/// Reads the positions again, relative to the origin that is returned, if those of the vertices that the mesh uses lie
/// far from 0 and others do not; returns 0 otherwise.
double3 center_far_vertices(const PlyRows& rows, Mesh& mesh);

/// Faces, strips or edges with the index of a vertex that does not exist: they are dropped.
struct PlyStrays {
  std::uint64_t count = 0;
  std::size_t row = 0;  ///< of the first one
  double index = 0;     ///< of that row's missing vertex

  void add(const PlyStrays& later) {
    if (count == 0) row = later.row, index = later.index;
    count += later.count;
  }
};

/// The triangles of a PLY file's faces.
struct PlyFaces {
  std::vector<std::uint32_t> index;
  std::vector<float2> corner_uv;       ///< one per index, if faces have their own texture coordinates
  std::vector<float4> corner_color;    ///< one per index, if faces have colours
  std::vector<std::uint16_t> texture;  ///< one per triangle, an index in PlyHeader::textures, if faces have one
  std::uint64_t too_short = 0, too_concave = 0;
  PlyStrays strays;
};

/// Whether all faces are triangles of 32-bit indices without other attributes, as in most files.
bool are_plain_triangles(const PlyRows& faces);

/// The property of faces that lists their vertices.
std::optional<std::size_t> find_indices(const PlyElement& faces);

/// Reads the indices of such faces on a fast path; empty if one refers to a vertex that does not exist.
///
/// Cost      12 bytes per face, which the caller charges to the budget.
std::vector<std::uint32_t> read_plain_triangles(const PlyRows& faces, std::size_t vertices);

/// Reads faces of any kind and triangulates them. `textures` is the number of the file's textures.
PlyFaces read_ply_faces(const PlyRows& rows, const Mesh& vertices, std::size_t textures, ImportBudget& budget);

/// Reads the triangles of strips: a negative index ends a strip, and so does that of a missing vertex.
std::vector<std::uint32_t> read_ply_strips(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget,
                                           PlyStrays& strays);

/// Reads the lines of edges, two indices each.
std::vector<std::uint32_t> read_ply_edges(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget,
                                          PlyStrays& strays);

}  // namespace zoneplate
