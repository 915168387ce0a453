// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/clip.h"

#include <algorithm>
#include <cmath>

namespace zoneplate {
namespace {

/// A homogeneous vertex with x and y already in 1/256 pixel: (x, y) / w is its position on the screen.
struct Corner {
  double x, y, z, w;
  int source;  ///< which of the triangle's vertices this is, or -1 if a plane made it
};

/// Signed distances to the planes, in the order of clipping; inside is >= 0.
double distance(const Corner& v, int plane) {
  const double guard = static_cast<double>(guard_band) * v.w;
  switch (plane) {
    case 0:
      return v.w - v.z;  // near
    case 1:
      return v.z;  // far
    case 2:
      return guard - v.x;
    case 3:
      return guard + v.x;
    case 4:
      return guard - v.y;
    default:
      return guard + v.y;
  }
}

struct Polygon {
  int count = 0;
  std::array<Corner, ClippedPolygon::capacity> corner;
};

Polygon cut(const Polygon& in, int plane) {
  Polygon out;
  for (int i = 0; i < in.count; ++i) {
    const Corner& p = in.corner[static_cast<std::size_t>(i)];
    const Corner& q = in.corner[static_cast<std::size_t>((i + 1) % in.count)];
    const double dp = distance(p, plane), dq = distance(q, plane);
    if (dp >= 0) out.corner[static_cast<std::size_t>(out.count++)] = p;
    if ((dp >= 0) == (dq >= 0)) continue;
    const Corner& from = dp >= 0 ? p : q;
    const Corner& to = dp >= 0 ? q : p;
    const double t = dp >= 0 ? dp / (dp - dq) : dq / (dq - dp);
    out.corner[static_cast<std::size_t>(out.count++)] = {from.x + t * (to.x - from.x), from.y + t * (to.y - from.y),
                                                         from.z + t * (to.z - from.z), from.w + t * (to.w - from.w),
                                                         -1};
  }
  return out;
}

/// True if all vertices lie on the outer side of one side plane of the image itself.
bool is_outside(const Polygon& p, Viewport viewport) {
  const auto all = [&](auto outside) { return std::all_of(p.corner.begin(), p.corner.begin() + p.count, outside); };
  const double half_width = viewport.width * 128.0, half_height = viewport.height * 128.0;
  return all([&](const Corner& c) { return c.x < -half_width * c.w; }) ||
         all([&](const Corner& c) { return c.x > half_width * c.w; }) ||
         all([&](const Corner& c) { return c.y < -half_height * c.w; }) ||
         all([&](const Corner& c) { return c.y > half_height * c.w; });
}

}  // namespace

ClippedPolygon clip_triangle(float4 a, float4 b, float4 c, Viewport viewport) {
  const float4 source[3] = {a, b, c};
  Polygon polygon;
  for (const float4& v : source) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w)) return {};
    polygon.corner[static_cast<std::size_t>(polygon.count)] = {static_cast<double>(v.x) * (viewport.width * 128),
                                                               static_cast<double>(v.y) * (viewport.height * -128), v.z,
                                                               v.w, polygon.count};
    ++polygon.count;
  }
  for (int plane = 0; plane < 6 && polygon.count > 0; ++plane) {
    polygon = cut(polygon, plane);
    if (plane == 1 && is_outside(polygon, viewport)) return {};
  }
  if (polygon.count < 3) return {};

  // An original vertex keeps the snapped position that its unclipped neighbours use. Rounding may leave a new vertex
  // slightly outside the plane that made it.
  ClippedPolygon out;
  for (int i = 0; i < polygon.count; ++i) {
    const Corner& v = polygon.corner[static_cast<std::size_t>(i)];
    if (!(v.w > 0)) return {};
    const ScreenVertex original = v.source >= 0 ? project(source[v.source], viewport) : ScreenVertex{};
    if (!original.needs_clipping()) {
      out.vertex[static_cast<std::size_t>(out.count++)] = original;
      continue;
    }
    const auto snap = [&](double s) {
      return static_cast<std::int32_t>(std::nearbyint(std::clamp(s / v.w, -1.0 * guard_band, 1.0 * guard_band)));
    };
    out.vertex[static_cast<std::size_t>(out.count++)] = {snap(v.x), snap(v.y),
                                                         static_cast<float>(std::clamp(v.z / v.w, 0.0, 1.0)) + 0.0f,
                                                         std::max(static_cast<float>(1 / v.w), 1e-38f)};
  }
  return out;
}

}  // namespace zoneplate
