// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/formats/obj/layout.h"
#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// A mesh of one object, one material and one kind of primitive.
struct ObjMesh {
  Mesh mesh;  ///< its material is the number of a name in ObjLayout::materials
  int object = 0;
};

struct ObjMeshes {
  std::vector<ObjMesh> meshes;    ///< in the order of their first elements; none is empty
  std::uint64_t not_finite = 0;   ///< elements that were dropped for a vertex that is not finite
  std::uint64_t too_concave = 0;  ///< polygons of too many corners to be cut rightly
};

/// Turns the elements into indexed primitives: n-gons into triangles, polylines into segments.
///
/// Corners that agree in position, texture coordinate and normal become one vertex; vertices are in the order of
/// their first use. Texture coordinates are turned to our origin at the top left, colours from sRGB codes to linear.
///
/// Errors    ErrorKind::Input when memory or time of the budget run out.
ObjMeshes make_meshes(const ObjFile& file, const ObjLayout& layout, const std::vector<std::vector<float3>>& normals,
                      ImportBudget& budget);

}  // namespace zoneplate
