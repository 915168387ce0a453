// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/triangle_facing.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/raster/geometry/clip.h"
#include "zoneplate/raster/types/tile_grid.h"

namespace zoneplate {

BarycentricPlanes barycentric_planes(float4 p, float4 q, float4 r, Viewport viewport) {
  const float4 v[3] = {p, q, r};
  BarycentricPlanes out;
  double greatest = 0;
  for (int k = 0; k < 3; ++k) {
    const float4 &from = v[(k + 1) % 3], &to = v[(k + 2) % 3];
    const double sx = viewport.width * 128, sy = viewport.height * -128;
    const double x1 = static_cast<double>(from.x) * sx, y1 = static_cast<double>(from.y) * sy, w1 = from.w;
    const double x2 = static_cast<double>(to.x) * sx, y2 = static_cast<double>(to.y) * sy, w2 = to.w;
    out.x[k] = y1 * w2 - w1 * y2;
    out.y[k] = w1 * x2 - x1 * w2;
    out.one[k] = x1 * y2 - y1 * x2;
    greatest = std::max({greatest, std::abs(out.x[k]), std::abs(out.y[k])});
  }
  if (!(greatest > 0)) return out;
  for (int k = 0; k < 3; ++k) out.x[k] /= greatest, out.y[k] /= greatest, out.one[k] /= greatest;
  return out;
}

namespace {

/// A point on the screen, 1/256 pixel from the image's top-left corner.
struct ScreenPoint {
  std::int32_t x, y;
};

/// The same as make_tile_triangle and depth_at.
float depth_of(const Triangle& t, ScreenPoint at) {
  const int column = at.x >> 8, row = at.y >> 8;
  const SamplePosition place{static_cast<std::uint8_t>(at.x & 255), static_cast<std::uint8_t>(at.y & 255)};
  TileTriangle here;
  make_tile_triangle(t, &place, 1, column / tile_size * tile_size, row / tile_size * tile_size, here);
  return depth_at(here, 0, column % tile_size, row % tile_size);
}

bool contains(const Triangle& t, ScreenPoint p) {
  for (std::size_t k = 0; k < 3; ++k)
    if (static_cast<std::int64_t>(t.a[k]) * p.x + static_cast<std::int64_t>(t.b[k]) * p.y + t.c[k] < 0) return false;
  return true;
}

/// The depth of the plane through homogeneous vertices, from their weights up to a common factor, which cancels.
float depth_of(const float4 (&corner)[3], ScreenPoint at, Viewport viewport) {
  const BarycentricPlanes planes = barycentric_planes(corner[0], corner[1], corner[2], viewport);
  const double px = at.x - viewport.width * 128, py = at.y - viewport.height * 128;
  double z = 0, w = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double weight = (planes.x[k] * px + planes.y[k] * py) + planes.one[k];
    z += weight * static_cast<double>(corner[k].z), w += weight * static_cast<double>(corner[k].w);
  }
  const double depth = z / w;
  return depth > 0 ? static_cast<float>(depth < 1 ? depth : 1.0) : 0.0f;
}

}  // namespace

float depth_at_point(const ProjectedDraws& projected, std::size_t d, std::int32_t triangle, std::int32_t x,
                     std::int32_t y, Viewport viewport, const RasterRules& rules) {
  const Draw& draw = projected.draws[d];
  const std::uint32_t* v = &draw.index[3 * static_cast<std::size_t>(triangle - projected.first_triangle[d])];
  const ScreenVertex p = projected.vertex(d, v[0]), q = projected.vertex(d, v[1]), r = projected.vertex(d, v[2]);
  const ScreenPoint at{x, y};
  if (!p.needs_clipping() && !q.needs_clipping() && !r.needs_clipping())
    return depth_of(make_triangle(p, q, r, triangle, viewport, rules), at);
  const float4 corner[3] = {draw.clip_position(v[0]), draw.clip_position(v[1]), draw.clip_position(v[2])};
  const ClippedPolygon polygon = clip_triangle(corner[0], corner[1], corner[2], viewport);
  for (int i = 2; i < polygon.count; ++i) {
    const ScreenVertex &a = polygon.vertex[0], &b = polygon.vertex[static_cast<std::size_t>(i - 1)],
                       &c = polygon.vertex[static_cast<std::size_t>(i)];
    if (doubled_area(a, b, c) == 0) continue;
    const Triangle piece = make_triangle(a, b, c, triangle, viewport, rules);
    if (contains(piece, at)) return depth_of(piece, at);
  }
  return depth_of(corner, at, viewport);
}

TriangleFacing face_of(const ProjectedDraws& projected, std::size_t d, std::int32_t triangle, Viewport viewport) {
  const Draw& draw = projected.draws[d];
  const std::uint32_t* v = &draw.index[3 * static_cast<std::size_t>(triangle - projected.first_triangle[d])];
  const ScreenVertex p = projected.vertex(d, v[0]), q = projected.vertex(d, v[1]), r = projected.vertex(d, v[2]);
  TriangleFacing out;
  out.needs_clipping = p.needs_clipping() || q.needs_clipping() || r.needs_clipping();
  if (!out.needs_clipping) {
    const std::int64_t area = doubled_area(p, q, r);
    out.is_degenerate = area == 0;
    out.is_clockwise = area > 0;
    return out;
  }
  // The determinant of the homogeneous vertices has the sign of the area of the part in front of the eye.
  const float4 a = draw.clip_position(v[0]);
  out.planes = barycentric_planes(a, draw.clip_position(v[1]), draw.clip_position(v[2]), viewport);
  const double area = (out.planes.x[0] * (static_cast<double>(a.x) * (viewport.width * 128)) +
                       out.planes.y[0] * (static_cast<double>(a.y) * (viewport.height * -128))) +
                      out.planes.one[0] * static_cast<double>(a.w);
  out.is_degenerate = !(area < 0 || area > 0);
  out.is_clockwise = area > 0;
  return out;
}

}  // namespace zoneplate
