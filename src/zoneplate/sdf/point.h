// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace zoneplate::sdf {

/// A point or vector of the plane in double precision: x to the right, y downwards.
struct Point {
  double x = 0, y = 0;
  bool operator==(const Point&) const = default;

  friend constexpr Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y}; }
  friend constexpr Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
  friend constexpr Point operator*(Point a, double s) { return {a.x * s, a.y * s}; }
  friend constexpr double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
  /// Positive if b is clockwise from a on the screen, where y points downwards.
  friend constexpr double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
  friend double length(Point a) { return std::sqrt(dot(a, a)); }
};

/// An axis-aligned rectangle; empty (low > high) until a point is added.
struct Bounds {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

  static constexpr Bounds everything() {
    constexpr double all = std::numeric_limits<double>::infinity();
    return {{-all, -all}, {all, all}};
  }
  bool empty() const { return low.x > high.x || low.y > high.y; }
  bool is_finite() const {
    return std::isfinite(low.x) && std::isfinite(low.y) && std::isfinite(high.x) && std::isfinite(high.y);
  }
  void add(Point p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  void add(const Bounds& b) {
    if (!b.empty()) add(b.low), add(b.high);
  }
  Bounds grown(double by) const { return {{low.x - by, low.y - by}, {high.x + by, high.y + by}}; }
  friend Bounds common(const Bounds& a, const Bounds& b) {
    return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
            {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
  }
};

/// A map that multiplies all distances by one number: p becomes scale · (rotation p) + move.
struct Similarity {
  double cosine = 1, sine = 0;  ///< of the rotation, clockwise on the screen
  bool is_mirrored = false;     ///< y is negated first
  double scale = 1;
  Point move;

  /// The image of a vector, which is not moved.
  constexpr Point turn(Point p) const {
    const double y = is_mirrored ? -p.y : p.y;
    return {scale * (cosine * p.x - sine * y), scale * (sine * p.x + cosine * y)};
  }
  constexpr Point operator()(Point p) const { return turn(p) + move; }
  /// First b, then a.
  friend constexpr Similarity operator*(const Similarity& a, const Similarity& b) {
    const double sine_b = a.is_mirrored ? -b.sine : b.sine;
    return {a.cosine * b.cosine - a.sine * sine_b, a.sine * b.cosine + a.cosine * sine_b,
            a.is_mirrored != b.is_mirrored, a.scale * b.scale, a(b.move)};
  }
  Bounds operator()(const Bounds& b) const {
    if (b.empty()) return b;
    if (!b.is_finite()) return Bounds::everything();
    Bounds out;
    for (const Point p : {b.low, b.high, Point{b.low.x, b.high.y}, Point{b.high.x, b.low.y}}) out.add((*this)(p));
    return out;
  }
};

}  // namespace zoneplate::sdf
