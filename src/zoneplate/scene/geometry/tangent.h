// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// Replaces the tangents by MikkTSpace's for the given uv set; vertices are split where tangents differ.
///
/// Triangles around a vertex form one group if they are connected by edges and their uv are not mirrored relative to
/// each other; a group's tangent is the mean of its triangles' tangents in the plane of the normal, weighted by the
/// angle at the vertex. Vertices with equal position, normal and uv count as one. The standard's rules for quadrangles
/// do not apply; its angular threshold has the default value, which splits nothing.
///
/// Shape     vertices keep their indices, copies are appended; the order of triangles and corners is kept.
/// Space     w is the sign for bitangent = w cross(normal, tangent), which points to the image's top as glTF's normal
///           textures require: uv as in the file, v downwards, so that the standard's sign is reversed.
/// Edges     a triangle without area takes the tangent that its vertex has in another triangle. Triangles without area
///           in uv join the groups of their neighbours, without weight; without neighbours, the tangent is any unit
///           vector perpendicular to the normal.
/// Requires  triangles with normals and that uv set, all finite.
/// Source    Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, and the standard implementation's rules.
void make_tangents(Mesh& mesh, int uv_set);

}  // namespace zoneplate
