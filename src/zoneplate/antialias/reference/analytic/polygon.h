// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace zoneplate::antialias {

/// A position in or near a pixel.
///
/// Units     pixels from the pixel's top-left corner, x right, y down.
struct Place {
  double x = 0, y = 0;
};

/// A straight line; `distance` is positive on its inner side, in pixels if a² + b² = 1.
struct Line {
  double a = 0, b = 0, c = 0;
  double distance(Place p) const { return (a * p.x + b * p.y) + c; }
};

/// A convex region of a pixel, with corners clockwise on the screen. A polygon without corners is empty.
struct ConvexPolygon {
  static constexpr int capacity = 20;
  int count = 0;
  std::array<Place, capacity> corner;

  ConvexPolygon() {}
  /// Copies only the used corners: most polygons have four or five.
  ConvexPolygon(const ConvexPolygon& other) { *this = other; }
  ConvexPolygon& operator=(const ConvexPolygon& other) {
    count = other.count;
    for (int i = 0; i < count; ++i) corner[static_cast<std::size_t>(i)] = other[i];
    return *this;
  }

  bool empty() const { return count == 0; }
  void add(Place p) { corner[static_cast<std::size_t>(count++)] = p; }
  const Place& operator[](int i) const { return corner[static_cast<std::size_t>(i)]; }
};

/// A polygon with more corners is not cut further as it is; three edges, or a grid, may add four before the next check.
inline constexpr int many_corners = 12;

/// The pixel itself: the unit square.
ConvexPolygon unit_square();

/// A corner within this distance of a line, in pixels, counts as on it: far above rounding errors, far below
/// visibility.
inline constexpr double on_line = 0x1p-36;

/// Cuts a polygon in two along a line. Corners within `on_line` of the line are assigned to the side of the others.
///
/// Exact     both parts get the same new corners, so that the areas of the parts sum to that of the whole within 1e-15.
/// Requires  fewer than `capacity` corners.
void cut(const ConvexPolygon& polygon, const Line& line, ConvexPolygon& inside, ConvexPolygon& outside);

/// True if no part of a polygon is inside of the line.
bool is_outside(const ConvexPolygon& polygon, const Line& line);

/// The inner part of `cut`.
ConvexPolygon clipped(const ConvexPolygon& polygon, const Line& line);

/// Cuts a polygon in two from its first corner to its middle one.
///
/// Requires  at least four corners.
void halve(const ConvexPolygon& polygon, ConvexPolygon& first, ConvexPolygon& second);

/// Calls use(column, row, part) for the intersection of the polygon with each cell of a grid of count × count squares,
/// row by row. The outermost cells extend beyond the grid.
///
/// Requires  fewer than capacity - 4 corners.
template <class Use>
void for_grid(const ConvexPolygon& polygon, Place corner, double side, int count, Use use) {
  ConvexPolygon row, rest = polygon, below, cell, right;
  for (int j = 0; j < count && !rest.empty(); ++j) {
    below.count = 0;
    if (j + 1 < count)
      cut(rest, {0, -1, corner.y + (j + 1) * side}, row, below);
    else
      row = rest;
    rest = below;
    for (int i = 0; i < count && !row.empty(); ++i) {
      right.count = 0;
      if (i + 1 < count)
        cut(row, {-1, 0, corner.x + (i + 1) * side}, cell, right);
      else
        cell = row;
      if (!cell.empty()) use(i, j, cell);
      row = right;
    }
  }
}

/// Area and first moments: ∫ dA, ∫ x dA and ∫ y dA.
struct AreaMoments {
  double area = 0, x = 0, y = 0;
};
AreaMoments area_moments(const ConvexPolygon& polygon);

}  // namespace zoneplate::antialias
