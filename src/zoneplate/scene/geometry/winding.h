// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// 1 if a triangle faces away from the normals of its three corners, -1 if it faces as they do, 0 if it has no area.
int turn_of(const float3 (&corner)[3], const float3 (&normal)[3]);

/// Reverses the triangles of a mesh.
void reverse(Mesh& mesh);

/// Reverses the triangles of a mesh if most of them face away from its vertex normals: a file's normals say which side
/// is outside, also where a program wrote its corners clockwise. A mesh without normals, or of points or lines, stays.
///
/// Exact     the same bits for any number of threads.
void turn_to_normals(Mesh& mesh);

}  // namespace zoneplate
