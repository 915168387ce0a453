// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/polygon.h"

#include <cassert>

namespace zoneplate::antialias {
namespace {

/// The side and distance of each corner relative to a line.
struct Sides {
  std::array<double, ConvexPolygon::capacity> distance;
  bool has_inside = false, has_outside = false;
};

Sides sides_of(const ConvexPolygon& polygon, const Line& line) {
  Sides out;
  for (int i = 0; i < polygon.count; ++i) {
    double d = line.distance(polygon[i]);
    if (d <= on_line && d >= -on_line) d = 0;
    out.has_inside = out.has_inside || d > 0;
    out.has_outside = out.has_outside || d < 0;
    out.distance[static_cast<std::size_t>(i)] = d;
  }
  return out;
}

/// Calls inside(p) and outside(p) with the corners of both parts, in order.
template <class Inside, class Outside>
void walk(const ConvexPolygon& polygon, const Sides& sides, Inside inside, Outside outside) {
  for (int i = 0; i < polygon.count; ++i) {
    const int j = i + 1 == polygon.count ? 0 : i + 1;
    const Place p = polygon[i], q = polygon[j];
    const double dp = sides.distance[static_cast<std::size_t>(i)], dq = sides.distance[static_cast<std::size_t>(j)];
    if (dp >= 0) inside(p);
    if (dp <= 0) outside(p);
    if (!((dp > 0 && dq < 0) || (dp < 0 && dq > 0))) continue;
    const double t = dp / (dp - dq);
    const Place crossing{p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)};
    inside(crossing);
    outside(crossing);
  }
}

}  // namespace

ConvexPolygon unit_square() {
  ConvexPolygon out;
  for (const Place p : {Place{0, 0}, {1, 0}, {1, 1}, {0, 1}}) out.add(p);
  return out;
}

void cut(const ConvexPolygon& polygon, const Line& line, ConvexPolygon& inside, ConvexPolygon& outside) {
  assert(polygon.count < ConvexPolygon::capacity);
  const Sides sides = sides_of(polygon, line);
  inside.count = outside.count = 0;
  if (!sides.has_outside) {
    inside = polygon;
  } else if (!sides.has_inside) {
    outside = polygon;
  } else {
    walk(
        polygon, sides, [&](Place p) { inside.add(p); }, [&](Place p) { outside.add(p); });
  }
}

bool is_outside(const ConvexPolygon& polygon, const Line& line) {
  for (int i = 0; i < polygon.count; ++i)
    if (line.distance(polygon[i]) > on_line) return false;
  return true;
}

ConvexPolygon clipped(const ConvexPolygon& polygon, const Line& line) {
  assert(polygon.count < ConvexPolygon::capacity);
  const Sides sides = sides_of(polygon, line);
  if (!sides.has_outside) return polygon;
  ConvexPolygon inside;
  if (sides.has_inside)
    walk(
        polygon, sides, [&](Place p) { inside.add(p); }, [](Place) {});
  return inside;
}

void halve(const ConvexPolygon& polygon, ConvexPolygon& first, ConvexPolygon& second) {
  assert(polygon.count >= 4);
  const int middle = polygon.count / 2;
  first.count = second.count = 0;
  for (int i = 0; i <= middle; ++i) first.add(polygon[i]);
  for (int i = middle; i < polygon.count; ++i) second.add(polygon[i]);
  second.add(polygon[0]);
}

AreaMoments area_moments(const ConvexPolygon& polygon) {
  // Relative to the first corner, so that a sliver far from the origin keeps its precision.
  AreaMoments m;
  if (polygon.count < 3) return m;
  const Place o = polygon[0];
  double x = 0, y = 0;
  for (int i = 2; i < polygon.count; ++i) {
    const double px = polygon[i - 1].x - o.x, py = polygon[i - 1].y - o.y;
    const double qx = polygon[i].x - o.x, qy = polygon[i].y - o.y;
    const double area = (px * qy - py * qx) / 2;
    m.area += area;
    x += area * (px + qx) / 3;
    y += area * (py + qy) / 3;
  }
  m.x = x + m.area * o.x;
  m.y = y + m.area * o.y;
  return m;
}

}  // namespace zoneplate::antialias
