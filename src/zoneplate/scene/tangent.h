#pragma once

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// Replaces the normals by flat ones: every triangle gets its own three vertices. Degenerate triangles get +Y.
void make_flat_normals(Mesh& mesh);

/// Replaces the tangents by MikkTSpace's for the given uv set; vertices are split where tangents differ.
///
/// Requires  triangles with normals and that uv set.
/// Source    Mikkelsen, Simulation of Wrinkled Surfaces Revisited, 2008, and the standard implementation's rules.
void make_tangents(Mesh& mesh, int uv_set);

}  // namespace zoneplate
