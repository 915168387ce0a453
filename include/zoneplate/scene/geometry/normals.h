// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/mesh.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// Makes the normals of a mesh anew: smooth across edges that bend by less than `crease` (radians, 50° by default),
/// flat everywhere for 0. Vertices are connected by indices only; where the corners of one differ, copies are appended.
/// Tangents, which belong to the old normals, are removed.
///
/// Requires  triangles of finite positions, and indices in range.
/// Exact     the same bits for any number of threads and any instruction set.
/// Source    Max, Weights for Computing Vertex Normals from Facet Normals, Journal of Graphics Tools 4(2), 1999.
void make_normals(Mesh& mesh, float crease = 0.87266463f);

}  // namespace zoneplate
#pragma GCC visibility pop
