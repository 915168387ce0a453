// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/sdf/outline.h"

namespace zoneplate::sdf {

/// Twice the area of the control polygons, each point as often as they wind around it: positive for a contour that runs
/// clockwise on the screen.
double signed_area(const Outline& outline);

/// The boundary of an outline's region: contours that do not cross or overlap, and wind around the points of the region
/// once, in the direction of the outline's signed area (clockwise on the screen if it is not negative), and around all
/// other points 0 times.
///
/// Segments are divided where they meet. A part between two meetings belongs to the boundary if the region is on one
/// side of it only.
///
/// Edges     contours may touch in points. A contour that meets no other one and not itself keeps its segments, to the
///           last bit, unless it is left out or reversed.
/// Exact     points less than 1e-8 of the outline's extent apart count as one.
/// Errors    ErrorKind::Input for more than 2^16 crossings.
/// Cost      grows with the pairs of segments whose bounds overlap, and with the meetings times the segments.
Outline boundary_of(const Outline& outline);

}  // namespace zoneplate::sdf
