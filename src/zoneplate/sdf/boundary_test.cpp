// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/boundary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/math/random.h"
#include "zoneplate/sdf/exact_coverage.h"
#include "zoneplate/sdf/field/field_image.h"

namespace zoneplate::sdf {
namespace {

struct Line {
  Point a, b;
};
std::vector<Line> flattened(const Outline& outline) {
  constexpr int lines = 100;  // of a curve
  std::vector<Line> out;
  for (const Contour& contour : outline.contours)
    for (const Segment& s : contour) {
      const int n = s.degree == 1 ? 1 : lines;
      for (int i = 0; i < n; ++i)
        out.push_back({i == 0 ? s.first() : s.at(static_cast<double>(i) / n),
                       i + 1 == n ? s.last() : s.at(static_cast<double>(i + 1) / n)});
    }
  return out;
}

int winding_around(const std::vector<Line>& lines, Point p) {
  int winding = 0;
  for (const auto& [a, b] : lines) {
    if ((a.y <= p.y) == (b.y <= p.y)) continue;
    const double side = cross(b - a, p - a);
    if (a.y <= p.y && side > 0) ++winding;
    if (a.y > p.y && side < 0) --winding;
  }
  return winding;
}

double distance_from(const Line& line, Point p) {
  const Point along = line.b - line.a;
  const double square = dot(along, along), t = square > 0 ? std::clamp(dot(p - line.a, along) / square, 0.0, 1.0) : 0;
  return length(p - line.a - along * t);
}

bool is_inside(int winding, Outline::Fill fill) {
  return fill == Outline::Fill::NonZero ? winding != 0 : winding % 2 != 0;
}

/// The lines of an outline with its region on one side only, cut where others cross them.
std::vector<Line> lines_of_boundary(const Outline& outline) {
  const std::vector<Line> lines = flattened(outline);
  std::vector<Line> out;
  for (const Line& line : lines) {
    std::vector<double> cuts = {0, 1};
    const Point along = line.b - line.a;
    for (const Line& other : lines) {
      const Point across = other.b - other.a;
      const double area = cross(along, across);
      for (const Point p : {other.a, other.b})
        if (distance_from(line, p) < 1e-12 && dot(along, along) > 0)
          cuts.push_back(dot(p - line.a, along) / dot(along, along));
      if (area == 0) continue;
      const double s = cross(other.a - line.a, across) / area, t = cross(other.a - line.a, along) / area;
      if (s > 0 && s < 1 && t >= 0 && t <= 1) cuts.push_back(s);
    }
    std::ranges::sort(cuts);
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      if (cuts[i] - cuts[i - 1] < 1e-12) continue;
      const Point middle = line.a + along * ((cuts[i] + cuts[i - 1]) / 2);
      const Point aside = Point{-along.y, along.x} * (1e-7 / length(along));
      if (is_inside(winding_around(lines, middle + aside), outline.fill) !=
          is_inside(winding_around(lines, middle - aside), outline.fill))
        out.push_back({line.a + along * cuts[i - 1], line.a + along * cuts[i]});
    }
  }
  return out;
}

double distance_from(const std::vector<Line>& lines, Point p) {
  double least = 1e9;
  for (const Line& line : lines) least = std::min(least, distance_from(line, p));
  return least;
}

constexpr int side = 32;  // texels of a field

/// Checks the boundary of an outline in a square of `side`, and the fields of its region.
void expect_region(const Outline& outline, const std::string& name) {
  const Outline boundary = boundary_of(outline);
  const std::vector<Line> before = flattened(outline), after = flattened(boundary);
  const std::vector<Line> edge = lines_of_boundary(outline);
  const int around = signed_area(outline) < 0 ? -1 : 1;
  for (const Contour& contour : boundary.contours)
    for (std::size_t i = 0; i < contour.size(); ++i)
      ASSERT_EQ(contour[i].last(), contour[(i + 1) % contour.size()].first()) << name << ": a gap";
  const FieldImage single = outline_field(outline, FieldKind::Single, side, side, 1, {}, 2 * side);
  const FieldImage multi = outline_field(outline, FieldKind::MultiAlpha, side, side, 1, {}, 2 * side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const Point p{x + 0.5, y + 0.5};
      const bool inside = is_inside(winding_around(before, p), outline.fill);
      const double distance = edge.empty() ? side : distance_from(edge, p);
      const float4 at = single.distances(x, y), channels = multi.distances(x, y);
      const float median =
          std::max(std::min(channels.x, channels.y), std::min(std::max(channels.x, channels.y), channels.z));
      if (distance_from(before, p) > 0.001) {
        ASSERT_EQ(winding_around(after, p), inside ? around : 0) << name << ' ' << x << ' ' << y;
        ASSERT_EQ(at.x > 0, inside) << name << ' ' << x << ' ' << y;
      }
      // Curves are lines in the test.
      if (!edge.empty()) {
        ASSERT_NEAR(std::abs(at.x), distance, 0.01) << name << ' ' << x << ' ' << y;
      }
      if (distance > 0.1 && distance_from(before, p) > 0.001) {
        ASSERT_EQ(median > 0, inside) << name << ' ' << x << ' ' << y << ' ' << distance;
      }
    }
}

void add(Outline& outline, std::initializer_list<Point> points) {
  Pen pen(outline);
  bool is_first = true;
  for (const Point p : points) std::exchange(is_first, false) ? pen.move_to(p) : pen.line_to(p);
}

Outline outline_of(std::initializer_list<std::initializer_list<Point>> contours) {
  Outline out;
  for (const auto& points : contours) add(out, points);
  return out;
}

TEST(SdfBoundary, IsThatOfTheRegionForContoursThatMeet) {
  const Outline cases[] = {
      outline_of({{{4, 12}, {28, 12}, {28, 20}, {4, 20}}, {{12, 4}, {20, 4}, {20, 28}, {12, 28}}}),  // a plus sign
      outline_of({{{4, 12}, {28, 12}, {28, 20}, {4, 20}}, {{12, 4}, {12, 28}, {20, 28}, {20, 4}}}),  // one reversed
      outline_of({{{4, 30}, {4, 9}, {22, 9}, {22, 21}, {10, 21}, {10, 3}, {16, 3}, {16, 30}}}),      // crosses itself
      outline_of({{{4, 6}, {28, 26}, {28, 6}, {4, 26}}}),                                            // figure of eight
      outline_of({{{3, 3}, {29, 3}, {29, 29}, {3, 29}}, {{9, 9}, {23, 9}, {23, 23}, {9, 23}}}),      // nested, the same
      outline_of({{{3, 3}, {29, 3}, {29, 29}, {3, 29}}, {{9, 9}, {9, 23}, {23, 23}, {23, 9}}}),      // a hole
      outline_of({{{3, 3}, {15, 3}, {15, 20}, {3, 20}}, {{15, 8}, {28, 8}, {28, 28}, {15, 28}}}),    // along an edge
      outline_of({{{3, 3}, {15, 3}, {15, 15}, {3, 15}}, {{15, 15}, {28, 15}, {28, 28}, {15, 28}}}),  // at a corner
      outline_of({{{3, 3}, {29, 3}, {29, 29}, {3, 29}}, {{3, 3}, {29, 3}, {29, 29}, {3, 29}}}),      // twice
      outline_of({{{3, 3}, {29, 3}, {29, 29}, {3, 29}}, {{3, 29}, {29, 29}, {29, 3}, {3, 3}}}),      // and back
      outline_of({{{3, 3}, {29, 3}, {29, 29}, {3, 29}}, {{3, 10}, {12, 10}, {12, 20}, {3, 20}}}),  // inside, at an edge
      outline_of({{{16, 3}, {24, 28}, {3, 12}, {29, 12}, {8, 28}}}),                               // a pentagram
  };
  int number = 0;
  for (Outline outline : cases)
    for (const Outline::Fill fill : {Outline::Fill::NonZero, Outline::Fill::EvenOdd}) {
      outline.fill = fill;
      expect_region(outline, "case " + std::to_string(number++ / 2));
      expect_region(outline.mapped({.is_mirrored = true, .move = {0, side}}), "mirrored " + std::to_string(number / 2));
    }
}

double uniform(std::uint32_t& seed) { return hash(seed++, 77) / 4294967296.0; }

/// Contours of lines and curves; with a step, coordinates are its multiples, so that edges and corners coincide.
Outline random_outline(std::uint32_t seed, double step) {
  seed *= 1000;
  const auto coordinate = [&] {
    const double v = 3 + (side - 6) * uniform(seed);
    return step > 0 ? std::floor(v / step) * step : v;
  };
  const auto point = [&] { return Point{coordinate(), coordinate()}; };
  Outline out;
  out.fill = uniform(seed) < 0.3 ? Outline::Fill::EvenOdd : Outline::Fill::NonZero;
  const int contours = 1 + static_cast<int>(3 * uniform(seed));
  for (int i = 0; i < contours; ++i) {
    Pen pen(out);
    pen.move_to(point());
    const int segments = 2 + static_cast<int>(5 * uniform(seed));
    for (int k = 0; k < segments; ++k) {
      const double kind = uniform(seed);
      const Point a = point(), b = point(), c = point();
      kind < 0.5 ? pen.line_to(a) : kind < 0.75 ? pen.quadratic_to(a, b) : pen.cubic_to(a, b, c);
    }
  }
  return out;
}

TEST(SdfBoundary, IsThatOfTheRegionForRandomContours) {
  for (std::uint32_t seed = 0; seed < 12; ++seed)
    for (const double step : {0.0, 1.0, 4.0})
      expect_region(random_outline(seed, step), "seed " + std::to_string(seed) + " step " + std::to_string(step));
}

TEST(SdfBoundary, KeepsContoursThatMeetNothing) {
  Outline ring;
  {
    Pen pen(ring);
    pen.move_to({3, 16});
    pen.cubic_to({3, 2}, {29, 2}, {29, 16});
    pen.quadratic_to({29, 29}, {3, 16});
    pen.close();
  }
  add(ring, {{10, 12}, {10, 17}, {20, 17}, {20, 12}});
  const Outline kept = boundary_of(ring);
  ASSERT_EQ(kept.contours.size(), ring.contours.size());
  for (std::size_t i = 0; i < kept.contours.size(); ++i) {
    ASSERT_EQ(kept.contours[i].size(), ring.contours[i].size());
    for (std::size_t k = 0; k < kept.contours[i].size(); ++k)
      for (int c = 0; c <= kept.contours[i][k].degree; ++c)
        EXPECT_EQ(kept.contours[i][k].p[c], ring.contours[i][k].p[c]) << i << ' ' << k;
  }
  EXPECT_TRUE(boundary_of({}).contours.empty());
}

}  // namespace
}  // namespace zoneplate::sdf
