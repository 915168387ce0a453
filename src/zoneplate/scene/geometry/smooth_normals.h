// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// The cosine of 50°.
inline constexpr float smooth_crease_cosine = 0.64278761f;

/// Computes smooth normals for triangles: smooth across edges that bend by less than 50°, or the angle of another
/// cosine.
///
/// The normal of a corner is the sum of the normals of the triangles at its vertex that deviate from its own triangle's
/// by less than that, each weighted by the sine of its angle at the vertex over the product of the two edges' lengths,
/// which is exact for vertices on a sphere. Vertices are connected by indices only.
///
/// Shape     vertices keep their indices; copies are appended where the corners of one vertex differ.
/// Edges     a vertex whose triangles all lack area gets +Y; where more than 256 triangles meet, all are included.
/// Requires  triangles, all finite.
/// Exact     the same bits for any number of threads and any instruction set; sums are in float for vertices without
///           creases, in double for others.
/// Cost      one byte per vertex in addition to the normals; more where edges are sharp.
/// Source    Max, Weights for Computing Vertex Normals from Facet Normals, Journal of Graphics Tools 4(2), 1999.
void make_smooth_normals(Mesh& mesh, float crease_cosine = smooth_crease_cosine);

}  // namespace zoneplate
