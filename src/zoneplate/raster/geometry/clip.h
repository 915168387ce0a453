// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "zoneplate/raster/geometry/project.h"

namespace zoneplate {

/// A convex polygon on the screen: the visible part of a clipped triangle, in the triangle's own winding.
struct ClippedPolygon {
  static constexpr int capacity = 9;  ///< three corners, and one more for each of six planes
  int count = 0;
  std::array<ScreenVertex, capacity> vertex;
};

/// Clips a triangle against the near and far planes and the guard band, in homogeneous space.
///
/// Each edge is cut from its inside end towards its outside end, so that two triangles that share an edge get the
/// same new vertex, bit for bit. w <= 0 is outside the near plane. The polygon is empty for a triangle that is wholly
/// outside the image or has a coordinate that is not finite.
///
/// Source    Sutherland and Hodgman, Reentrant Polygon Clipping, CACM 17(1), 1974.
ClippedPolygon clip_triangle(float4 a, float4 b, float4 c, Viewport viewport);

}  // namespace zoneplate
