// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/plane.h"
#include "zoneplate/sdf/draw.h"

namespace zoneplate::sdf {

/// The exact area of an outline in each pixel.
///
/// Requires  contours do not cross; a contour within another has the opposite direction, or the rule is EvenOdd.
/// Exact     within 1e-6 for lines; curves are replaced by lines at most 1e-5 pixel away.
/// Source    the signed area to the right of each edge is accumulated along rows: Kaasila's and Levien's font rasterizers.
Plane<float> exact_coverage(const Outline& outline, const Raster& raster);

}  // namespace zoneplate::sdf
