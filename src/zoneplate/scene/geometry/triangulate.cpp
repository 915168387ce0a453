// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/triangulate.h"

#include <cmath>

namespace zoneplate {
namespace {

struct Point {
  double x = 0, y = 0;
  bool operator==(const Point&) const = default;
};

/// Positive if a, b, c turn left.
double turn(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// The corners projected along the axis closest to the polygon's normal.
std::vector<Point> flattened(std::span<const float3> polygon) {
  const std::array<double, 3> n = area_vector(polygon);
  const double x = std::abs(n[0]), y = std::abs(n[1]), z = std::abs(n[2]);
  const std::size_t drop = z >= x && z >= y ? 2 : y >= x ? 1 : 0;
  std::vector<Point> points;
  points.reserve(polygon.size());
  for (const float3 p : polygon) {
    const std::array<double, 3> c = {p.x, p.y, p.z};
    const Point q{c[(drop + 1) % 3], c[(drop + 2) % 3]};
    points.push_back(n[drop] < 0 ? Point{q.y, q.x} : q);
  }
  return points;
}

/// Whether all corners turn left and the outline has one turn (its x direction changes sign twice).
bool is_convex(const std::vector<Point>& p) {
  const std::size_t n = p.size();
  int changes = 0;
  double last = 0, first = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point a = p[i], b = p[(i + 1) % n], c = p[(i + 2) % n];
    if (turn(a, b, c) < 0) return false;
    const double dx = b.x - a.x;
    if (dx == 0) continue;
    if (last != 0 && (dx > 0) != (last > 0)) ++changes;
    if (first == 0) first = dx;
    last = dx;
  }
  return changes + ((first > 0) != (last > 0) ? 1 : 0) <= 2;
}

void add_fan(std::size_t corners, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  for (std::uint32_t i = 1; i + 1 < corners; ++i) triangles.push_back({0, i, i + 1});
}

/// The remaining outline while ears are cut off.
class Outline {
 public:
  explicit Outline(const std::vector<Point>& points) : points_(points), after_(points.size()), before_(points.size()) {
    const auto n = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < n; ++i) after_[i] = (i + 1) % n, before_[i] = (i + n - 1) % n;
  }

  std::uint32_t after(std::uint32_t i) const { return after_[i]; }
  std::uint32_t before(std::uint32_t i) const { return before_[i]; }
  void remove(std::uint32_t i) {
    after_[before_[i]] = after_[i];
    before_[after_[i]] = before_[i];
  }

  /// Whether the corner is an ear: it turns left (or is straight, if `may_be_straight`), and no other corner is in its
  /// triangle. The number of tested corners is added to `looked_at`.
  bool is_ear(std::uint32_t i, bool may_be_straight, std::uint64_t& looked_at) const {
    ++looked_at;
    const Point a = points_[before_[i]], b = points_[i], c = points_[after_[i]];
    const double bend = turn(a, b, c);
    if (bend < 0 || (bend == 0 && !may_be_straight)) return false;
    for (std::uint32_t k = after_[after_[i]]; k != before_[i]; k = after_[k], ++looked_at) {
      const Point p = points_[k];
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }

 private:
  const std::vector<Point>& points_;
  std::vector<std::uint32_t> after_, before_;
};

/// Cuts ears until three corners remain; false if the search was abandoned.
bool cut_ears(const std::vector<Point>& points, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  // An outline with very many self-intersections has few ears, and searching all corners for each would take cubic
  // time. Simple outlines take a small fraction of this limit.
  const std::uint64_t enough = (1 << 16) + 2 * std::uint64_t{points.size()} * points.size();
  std::uint64_t looked_at = 0;
  Outline outline(points);
  std::uint32_t i = 1;
  for (std::size_t left = points.size(); left > 3; --left) {
    // One round for a proper ear, another one for a straight corner; an outline with self-intersections may have
    // neither.
    std::size_t tried = 0;
    while (looked_at < enough && tried < 2 * left && !outline.is_ear(i, tried >= left, looked_at))
      i = outline.after(i), ++tried;
    triangles.push_back({outline.before(i), i, outline.after(i)});
    outline.remove(i);
    i = outline.after(i);
  }
  triangles.push_back({outline.before(i), i, outline.after(i)});
  return looked_at < enough;
}

}  // namespace

std::array<double, 3> area_vector(std::span<const float3> polygon) {
  // Relative to the first corner, so that a small polygon far from the origin keeps its precision.
  std::array<double, 3> sum{};
  if (polygon.empty()) return sum;
  const float3 o = polygon[0];
  const auto from_first = [&](std::size_t i) {
    const float3 p = polygon[i];
    return std::array<double, 3>{double{p.x} - double{o.x}, double{p.y} - double{o.y}, double{p.z} - double{o.z}};
  };
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const std::array<double, 3> a = from_first(i), b = from_first(i + 1);
    sum[0] += a[1] * b[2] - a[2] * b[1];
    sum[1] += a[2] * b[0] - a[0] * b[2];
    sum[2] += a[0] * b[1] - a[1] * b[0];
  }
  return sum;
}

bool triangulate(std::span<const float3> polygon, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  constexpr std::size_t max_corners = 4096;
  if (polygon.size() <= 3) {
    add_fan(polygon.size(), triangles);
    return true;
  }
  const std::vector<Point> points = flattened(polygon);
  const bool convex = is_convex(points);
  if (!convex && polygon.size() <= max_corners) return cut_ears(points, triangles);
  add_fan(polygon.size(), triangles);
  return convex;
}

}  // namespace zoneplate
