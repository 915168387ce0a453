#pragma once

#include "zoneplate/render/frame.h"

namespace zoneplate::antialias {

/// Where the edge lies that crosses pixel (x, y): its signed distance along the row or the column, in (-0.5, 0.5); the
/// other axis, or both, have 0.5 or more.
///
/// `distance` is Frame::edge_distance. Where the pixel's own triangle has no edge in it, those count that its four
/// neighbours store and that lie in it; of several the last in the order left, right, above, below.
float2 gbaa_offset(const Plane<float2>& distance, int x, int y);

}  // namespace zoneplate::antialias
