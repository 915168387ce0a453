// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// Gives triangles smooth normals: across edges that bend by less than 50°.
///
/// The normal of a corner is the sum over the triangles about its vertex that bend away from its own by less than 50°,
/// each weighted by the sine of its angle there over the product of the two edges' lengths, which is exact for vertices
/// on a sphere. Vertices are joined as the indices join them.
///
/// Shape     vertices keep their places; copies are appended where the corners of one vertex differ.
/// Edges     a vertex about which no triangle has an area gets +Y; where more than 256 triangles meet all are taken.
/// Requires  triangles, all finite.
/// Exact     the same bits for any number of threads and any instruction set; of vertices that are smooth all around,
///           sums in floats, of others in doubles.
/// Cost      one byte per vertex in addition to the normals; more where edges are sharp.
/// Source    Max, Weights for Computing Vertex Normals from Facet Normals, Journal of Graphics Tools 4(2), 1999.
void make_smooth_normals(Mesh& mesh);

}  // namespace zoneplate
