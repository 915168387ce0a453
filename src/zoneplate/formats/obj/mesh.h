// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/formats/obj/layout.h"
#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// A mesh of one object, one material and one kind of primitive.
struct ObjMesh {
  Mesh mesh;  ///< its material is an index into ObjLayout::materials
  int object = 0;
};

struct ObjMeshes {
  std::vector<ObjMesh> meshes;    ///< in the order of their first elements; none is empty
  std::uint64_t not_finite = 0;   ///< elements that were dropped because a vertex is not finite
  std::uint64_t too_concave = 0;  ///< polygons with too many corners to be triangulated correctly
};

/// Converts the elements into indexed primitives: polygons into triangles, polylines into segments.
///
/// Corners with the same position, texture coordinate and normal become one vertex; vertices are in the order of their
/// first use. Texture coordinates are flipped so that their origin is at the top left, colours are converted from sRGB
/// codes to linear.
///
/// Errors    ErrorKind::Input if the budget's memory or time is exceeded.
ObjMeshes make_meshes(const ObjFile& file, const ObjLayout& layout, const std::vector<std::vector<float3>>& normals,
                      ImportBudget& budget);

}  // namespace zoneplate
