// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/raster/geometry/draw.h"
#include "zoneplate/raster/types/viewport.h"

namespace zoneplate {

/// The perspective-correct barycentric weights of a triangle that crosses the eye's plane, as functions of the point on
/// the screen: b_k = q_k / (q_0 + q_1 + q_2) with q_k = x[k] P.x + y[k] P.y + one[k].
///
/// Units     P in 1/256 pixel from the image's centre. The greatest of x and y has the size 1.
/// Source    the 2D homogeneous form, which needs no division by w: Olano and Greer, Triangle Scan Conversion using 2D
///           Homogeneous Coordinates, 1997.
struct BarycentricPlanes {
  double x[3], y[3], one[3];
};
BarycentricPlanes barycentric_planes(float4 p, float4 q, float4 r, Viewport viewport);

/// The properties of a whole triangle that shading and culling use.
struct TriangleFacing {
  BarycentricPlanes planes;    ///< if it needs clipping
  bool is_degenerate = false;  ///< no area on the screen
  bool is_clockwise = false;   ///< as seen on the screen
  bool needs_clipping = false;
};

TriangleFacing face_of(const ProjectedDraws& projected, std::size_t draw, std::int32_t triangle, Viewport viewport);

/// The reversed depth of a triangle at a point on the screen: the depth of a sample at this point, of the triangle or
/// of the clipped piece that contains the point. Outside the triangle it is clamped to the depths of the triangle's
/// vertices; where no clipped piece contains the point, it is the depth of the triangle's plane.
///
/// Units     x, y in 1/256 pixel from the image's top-left corner, not negative.
float depth_at_point(const ProjectedDraws& projected, std::size_t draw, std::int32_t triangle, std::int32_t x,
                     std::int32_t y, Viewport viewport, const RasterRules& rules);

}  // namespace zoneplate
