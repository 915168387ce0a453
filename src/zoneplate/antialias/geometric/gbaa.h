// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/render/frame.h"

namespace zoneplate::antialias {

/// The edge that crosses pixel (x, y): its signed distance along the row or the column, in (-0.5, 0.5). The other axis,
/// or both without an edge, have 0.5 or more.
///
/// `distance` is Frame::edge_distance. If the pixel's own triangle has no edge within the pixel, the edges stored by
/// its four neighbours are used if they are within it; of several, the last in the order left, right, above, below.
float2 gbaa_offset(const Plane<float2>& distance, int x, int y);

}  // namespace zoneplate::antialias
