// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Twice the area of a polygon, as a vector along its normal (the sum over its edges), in double.
///
/// Source    Newell's method: Sutherland, Sproull, Schumacker, A Characterization of Ten Hidden-Surface Algorithms, ACM
///           Computing Surveys 6(1), 1974.
std::array<double, 3> area_vector(std::span<const float3> polygon);

/// Adds the n - 2 triangles of a simple polygon, as indices of its corners, with the same orientation.
///
/// A convex polygon becomes a fan about its first corner. Another one is triangulated by ear clipping in its plane
/// (that of its area_vector); where it intersects itself, triangles overlap.
///
/// Requires  all corners are finite.
/// Edges     fewer than three corners: no triangles. A concave polygon of more than 4096 corners becomes a fan, which
///           is incorrect but bounded, and the search for ears is abandoned for excessive self-intersection; in both
///           cases the function returns false.
/// Cost      at most quadratic in the corners of a concave polygon.
bool triangulate(std::span<const float3> polygon, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace zoneplate
