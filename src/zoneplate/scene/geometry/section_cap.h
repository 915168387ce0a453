// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "zoneplate/math/vec.h"

namespace zoneplate {

/// A straight part of an outline in a plane, with the inside to its left as seen against the normal.
struct OutlineSegment {
  float3 from, to;
};

/// The triangles that fill closed outlines in the plane of a unit normal, counter-clockwise about it: where the winding
/// number is not zero.
///
/// The plane is swept along one of its axes: between two neighbouring corners the filled parts are trapezoids, whose
/// sides also have the corners of the trapezoids next to them. Segments of which some end has not as many beginnings as
/// ends, directly or through others, are left out.
/// Exact     depends on the segments only, in any order but for equal coordinates; the same bits everywhere.
/// Edges     outlines that cross between two corners are filled as if they crossed at one of them.
std::vector<std::array<float3, 3>> fill_outlines(const std::vector<OutlineSegment>& segments, double3 normal);

}  // namespace zoneplate
