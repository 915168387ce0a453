// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// Replaces the tangents by MikkTSpace's for the given uv set; vertices are split where tangents differ.
///
/// Triangles around a vertex form one group where they are joined by edges and their uv are not mirrored against
/// each other; a group's tangent is the mean of its triangles' tangents in the plane of the normal, weighted by the
/// angle at the vertex. Vertices of equal position, normal and uv count as one. Of the standard's rules for
/// quadrangles none is needed; its angular threshold has the default value, which splits nothing.
///
/// Shape     vertices keep their places, copies are appended; the order of triangles and corners stays.
/// Space     w is the sign for bitangent = w cross(normal, tangent), which points to the image's top as glTF's normal
///           textures require: uv as in the file, v downwards, hence the standard's sign reversed.
/// Edges     a triangle without area takes the tangent that its vertex has in another triangle. Triangles without area
///           in uv join the groups of their neighbours, without weight; where there is none, the tangent is any unit
///           vector across the normal.
/// Requires  triangles with normals and that uv set, all finite.
/// Source    Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, and the standard implementation's rules.
void make_tangents(Mesh& mesh, int uv_set);

}  // namespace zoneplate
