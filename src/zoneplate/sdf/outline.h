// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "zoneplate/sdf/point.h"

namespace zoneplate::sdf {

/// A line (degree 1), or a quadratic or cubic Bézier curve (degree 2, 3), by its control points.
struct Segment {
  int degree = 1;
  Point p[4];

  Point first() const { return p[0]; }
  Point last() const { return p[degree]; }
  Point at(double t) const;
  /// The derivatives by t.
  Point velocity(double t) const;
  Point acceleration(double t) const;
  /// The direction at an end, also where the first control points coincide; zero for a segment of length 0.
  Point direction_at_start() const;
  Point direction_at_end() const;
  /// The segment from t = a to t = b; the ends a = 0 and b = 1 keep their points exactly.
  Segment part(double a, double b) const;
  /// The same curve as a cubic.
  Segment elevated() const;
  /// Of the control points, which contain the curve.
  Bounds bounds() const;
};

/// Consecutive segments, each of which starts at the end of the one before; the first starts at the end of the last.
using Contour = std::vector<Segment>;

/// Closed contours that bound a region: the points around which the contours wind a number of times that is not 0, or
/// is odd.
///
/// Edges     a contour that runs through the interior of the region counts as a part of its boundary for distances.
struct Outline {
  std::vector<Contour> contours;
  enum class Fill { NonZero, EvenOdd } fill = Fill::NonZero;

  Bounds bounds() const;
  std::size_t size() const;  ///< segments
  /// The outline with every point mapped.
  Outline mapped(const Similarity& map) const;
};

/// Adds contours to an outline; each is closed by a line where its ends differ. Segments of length 0 are left out.
class Pen {
 public:
  explicit Pen(Outline& outline) : outline_(outline) {}
  ~Pen() { close(); }
  Pen(const Pen&) = delete;
  Pen& operator=(const Pen&) = delete;

  Point at() const { return at_; }
  void move_to(Point p);
  void line_to(Point p);
  void quadratic_to(Point control, Point p);
  void cubic_to(Point control1, Point control2, Point p);
  void close();

 private:
  void add(const Segment& segment);

  Outline& outline_;
  Contour contour_;
  Point start_, at_;
};

/// The polygon through these points.
Outline polygon(std::span<const Point> points);

/// The piece of a segment that is monotone in x and in y, and turns by no more than about 60°, so that Newton's method
/// finds its nearest point. Their union is the segment.
///
/// Edges     a curve with a cusp is divided near it into lines of at most 1/1024 of its parameter.
std::vector<Segment> gentle_parts(const Segment& segment);

/// The point of a segment that is nearest to p, by its parameter.
///
/// Exact     the least of all local minima that are separated by more than 1/32 of the parameter.
double nearest_parameter(const Segment& segment, Point p);

}  // namespace zoneplate::sdf
