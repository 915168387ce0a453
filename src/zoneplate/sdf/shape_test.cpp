// SPDX-License-Identifier: Apache-2.0
// Distances of every shape at 10^5 points against the nearest of dense points on its boundary.
#include "zoneplate/sdf/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/sdf/draw.h"
#include "zoneplate/sdf/evaluate.h"

namespace zoneplate::sdf {
namespace {

constexpr double tolerance = 1e-5;

Point random_point(std::uint32_t i, double reach) {
  return {(2 * static_cast<double>(unit_float(hash(i, 1))) - 1) * reach,
          (2 * static_cast<double>(unit_float(hash(i, 2))) - 1) * reach};
}

/// What float coordinates hold, so that both sides measure the same point.
Point rounded(Point p) {
  return {static_cast<double>(static_cast<float>(p.x)), static_cast<double>(static_cast<float>(p.y))};
}

/// A closed curve by its points, a function of [0, 1), which is divided into `count` chords that are refined around the
/// nearest one by golden sections.
class Boundary {
 public:
  /// The curve consists of `parts` with equal intervals of its parameter; between them it may have corners.
  Boundary(std::function<Point(double)> at, int count, int parts)
      : at_(std::move(at)), count_(count), part_(count / parts) {
    for (int i = 0; i < count; ++i) ends_.push_back(at_(static_cast<double>(i) / count));
  }

  double distance(Point p) const {
    const auto to = [&](double t) { return length(at_(t - std::floor(t)) - p); };
    const int count = count_;
    double best = 1e300;
    for (int i = 0; i < count; ++i) {
      const auto of = [&](int k) { return length(ends_[static_cast<std::size_t>((k + count) % count)] - p); };
      if (i % part_ != 0 && (of(i) > of(i - 1) || of(i) > of(i + 1))) continue;
      best = std::min(best, of(i));
      for (const int side : {-1, 0}) {
        double a = static_cast<double>(i + side) / count, b = static_cast<double>(i + side + 1) / count;
        for (int k = 0; k < 42; ++k) {
          const double step = (b - a) * 0.381966, c = a + step, d = b - step;
          (to(c) < to(d) ? b : a) = to(c) < to(d) ? d : c;
        }
        best = std::min(best, to((a + b) / 2));
      }
    }
    return best;
  }

 private:
  std::function<Point(double)> at_;
  int count_, part_;
  std::vector<Point> ends_;
};

/// How many distances are compared with those of a Boundary, each of which takes thousands of its points.
constexpr int searched_points = 30'000;

/// The distance to the sides of a polygon, and whether the point is inside, by angles.
double polygon_distance(std::span<const Point> corners, Point p) {
  double best = 1e300, angle = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Point a = corners[i], b = corners[(i + 1) % corners.size()], along = b - a;
    const double t = std::clamp(dot(p - a, along) / dot(along, along), 0.0, 1.0);
    best = std::min(best, length(p - (a + along * t)));
    angle += std::atan2(cross(a - p, b - p), dot(a - p, b - p));
  }
  return std::abs(angle) > std::numbers::pi ? -best : best;
}

/// Compares `count` distances with `expected`.
template <class Expected>
void expect_distances(const ShapePtr& shape, double reach, const Expected& expected, int count = 100'000) {
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) points.push_back(rounded(random_point(static_cast<std::uint32_t>(i), reach)));
  // Neighbours in a batch are close together, as pixels are.
  std::sort(points.begin(), points.end(), [](Point a, Point b) {
    const auto key = [](Point p) { return std::pair(std::floor(p.y * 16), p.x); };
    return key(a) < key(b);
  });
  const std::vector<float> found = distances_at(shape, points);
  double worst = 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double difference = std::abs(static_cast<double>(found[i]) - expected(points[i]));
    if (difference > worst) worst = difference, at = i;
  }
  EXPECT_LT(worst, tolerance) << "at (" << points[at].x << ", " << points[at].y << "): " << found[at];
  testing::Test::RecordProperty("worst", std::to_string(worst));
}

TEST(SdfShape, CircleIsExact) {
  expect_distances(circle(0.7), 1.5, [](Point p) { return length(p) - 0.7; });
}

TEST(SdfShape, RectangleAndSquareAreExact) {
  for (const Point size : {Point{1, 1}, Point{1.6, 0.3}}) {
    const Point c[] = {
        {-size.x / 2, -size.y / 2}, {size.x / 2, -size.y / 2}, {size.x / 2, size.y / 2}, {-size.x / 2, size.y / 2}};
    expect_distances(rectangle(size.x, size.y), 1.5, [&](Point p) { return polygon_distance(c, p); });
  }
}

TEST(SdfShape, EllipseIsExact) {
  for (const Point r : {Point{1, 0.6}, Point{0.2, 0.9}, Point{1, 0.05}}) {
    const auto at = [r](double t) {
      return Point{r.x * std::cos(2 * std::numbers::pi * t), r.y * std::sin(2 * std::numbers::pi * t)};
    };
    const Boundary edge(at, 256, 1);
    expect_distances(
        ellipse(r.x, r.y), 1.5,
        [&](Point p) {
          const double d = edge.distance(p);
          return p.x * p.x / (r.x * r.x) + p.y * p.y / (r.y * r.y) < 1 ? -d : d;
        },
        searched_points);
  }
}

/// The distance to an ellipse with the radii a >= b, by bisection of the equation of its nearest point.
double ellipse_distance(double a, double b, Point p) {
  const double x = std::abs(p.x), y = std::abs(p.y), k = (a - b) * (a + b),
               sign = x * x / (a * a) + y * y / (b * b) < 1 ? -1 : 1;
  // The nearest point is (a² x / (t + k), b² y / t), where the squares of its coordinates over the radii have the
  // sum 1.
  const double least = std::max(b * y, a * x - k);
  if (least <= 0 || y == 0) {
    const double cosine = a * x / k;
    return sign *
           (cosine < 1 ? length(Point{x - a * cosine, b * std::sqrt((1 - cosine) * (1 + cosine))}) : std::abs(x - a));
  }
  double low = least, high = length(Point{a * x, b * y});
  for (int i = 0; i < 200; ++i) {
    const double t = high > 4 * low ? std::sqrt(low * high) : (low + high) / 2, u = a * x / (t + k), v = b * y / t;
    (u * u + v * v > 1 ? low : high) = t;
  }
  return sign * length(Point{x - a * (a * x / (low + k)), y - b * (b * y / low)});
}

TEST(SdfShape, ThinEllipsesAreExact) {
  const auto random = [](int i, std::uint32_t k) {
    return static_cast<double>(unit_float(hash(static_cast<std::uint32_t>(i), k)));
  };
  for (const float ratio : {1.001f, 1.5f, 7.0f, 100.0f, 1e3f, 1e4f, 1e5f}) {
    const double a = 0.75, b = static_cast<double>(0.75f / ratio), cusp = (a - b) * (a + b) / a;
    std::vector<Point> wide = {{0, 0}, {a, 0}, {0, b}, {cusp, 0}, {a / 2, 0}, {a / 2, b / 2}, {a * 1.01, b / 4}};
    for (int i = 0; i < 20'000; ++i) {
      const double u = random(i, 0), v = random(i, 1), angle = std::pow(u, 3) * std::numbers::pi / 2;
      const double cosine = std::cos(angle), sine = std::sin(angle);
      const Point kinds[] = {
          {u * 1.5, v * 1.5},                                             // anywhere
          {u * a, v * b},                                                 // in the box of the ellipse
          {u * 1.2 * a, v * 1e-3 * b},                                    // near the long axis
          {a * (1 + (u - 0.5) * 0.01), v * 2 * b},                        // at its end
          {cosine * a * (1 + v * 1e-3), sine * b * (1 + v * 1e-3)},       // at the boundary
          {cusp * std::pow(cosine, 3), cusp * a / b * std::pow(sine, 3)}  // at the evolute
      };
      wide.push_back(kinds[i % 6]);
    }
    std::vector<Point> tall;
    for (Point& p : wide) p = rounded(p), tall.push_back({-p.y, p.x});
    const std::vector<float> of_wide = distances_at(ellipse(a, b), wide), of_tall = distances_at(ellipse(b, a), tall);
    double worst = 0;
    for (std::size_t i = 0; i < wide.size(); ++i) {
      const double expected = ellipse_distance(a, b, wide[i]), size = std::max(1.0, length(wide[i]));
      const double off = std::max(std::abs(static_cast<double>(of_wide[i]) - expected),
                                  std::abs(static_cast<double>(of_tall[i]) - expected));
      worst = std::max(worst, off / size);
    }
    EXPECT_LT(worst, 1e-6) << "1 to " << ratio;
  }
}

TEST(SdfShape, PolygonsAreExact) {
  const Point rhombus_corners[] = {{0, -0.4}, {0.9, 0}, {0, 0.4}, {-0.9, 0}};
  expect_distances(rhombus(1.8, 0.8), 1.5, [&](Point p) { return polygon_distance(rhombus_corners, p); });
  const Point trapezoid_corners[] = {{-0.3, -0.5}, {0.3, -0.5}, {0.8, 0.5}, {-0.8, 0.5}};
  expect_distances(trapezoid(0.6, 1.6, 1), 1.5, [&](Point p) { return polygon_distance(trapezoid_corners, p); });
  const Point triangle_corners[] = {{0, -0.5}, {0.35, 0.5}, {-0.35, 0.5}};
  expect_distances(triangle(0.7, 1), 1.5, [&](Point p) { return polygon_distance(triangle_corners, p); });
  for (const int n : {3, 5, 8, 24}) {
    std::vector<Point> corners;
    for (int i = 0; i < n; ++i)
      corners.push_back({0.9 * std::sin(2 * std::numbers::pi * i / n), -0.9 * std::cos(2 * std::numbers::pi * i / n)});
    expect_distances(regular_polygon(0.9, n), 1.5, [&](Point p) { return polygon_distance(corners, p); });
  }
  // Not convex, with a horizontal side, and in either direction.
  std::vector<Point> star;
  for (int i = 0; i < 10; ++i) {
    const double r = i % 2 == 0 ? 1 : 0.4, a = std::numbers::pi * i / 5;
    star.push_back({r * std::sin(a), -r * std::cos(a)});
  }
  star.insert(star.begin() + 5, {{0.5, 0.9}, {0.2, 0.9}});
  expect_distances(region(polygon(star)), 1.5, [&](Point p) { return polygon_distance(star, p); });
  std::reverse(star.begin(), star.end());
  expect_distances(region(polygon(star)), 1.5, [&](Point p) { return polygon_distance(star, p); });
}

/// A contour with both kinds of curves, an inflection, a near-cusp and a line; the parameter runs over its segments.
Outline curved() {
  Outline outline;
  Pen pen(outline);
  pen.move_to({-0.8, -0.5});
  pen.quadratic_to({-0.2, -1.3}, {0.3, -0.4});
  pen.cubic_to({0.9, -1.2}, {0.5, 0.6}, {0.9, 0.3});
  pen.cubic_to({0.6, 1.2}, {-0.9, -0.2}, {-0.4, 0.9});
  pen.line_to({-0.8, 0.7});
  pen.close();
  return outline;
}

TEST(SdfShape, CurvesAreExact) {
  const Outline outline = curved();
  const Contour& contour = outline.contours.at(0);
  std::vector<Point> fine;
  for (const Segment& s : contour)
    for (int i = 0; i < 4096; ++i) fine.push_back(s.at(i / 4096.0));
  const auto at = [&](double t) {
    const double u = t * static_cast<double>(contour.size());
    const auto i = std::min(static_cast<std::size_t>(u), contour.size() - 1);
    return contour[i].at(u - static_cast<double>(i));
  };
  const Boundary edge(at, 500, static_cast<int>(contour.size()));
  expect_distances(
      region(outline), 1.5,
      [&](Point p) {
        const double d = edge.distance(p);
        double angle = 0;
        for (std::size_t i = 0; i < fine.size(); i += 64)
          angle += std::atan2(cross(fine[i] - p, fine[(i + 64) % fine.size()] - p),
                              dot(fine[i] - p, fine[(i + 64) % fine.size()] - p));
        // Near the boundary, the sign of the chords' polygon is not that of the curves.
        if (d < 1e-3) {
          angle = 0;
          for (std::size_t i = 0; i < fine.size(); ++i)
            angle += std::atan2(cross(fine[i] - p, fine[(i + 1) % fine.size()] - p),
                                dot(fine[i] - p, fine[(i + 1) % fine.size()] - p));
        }
        return std::abs(angle) > std::numbers::pi ? -d : d;
      },
      searched_points);
}

TEST(SdfShape, OperationsAreThoseOfTheDistances) {
  const ShapePtr a = circle(0.6), b = moved({0.5, 0.1}, rectangle(0.8, 0.5));
  const Point box[] = {{0.1, -0.15}, {0.9, -0.15}, {0.9, 0.35}, {0.1, 0.35}};
  const auto da = [](Point p) { return length(p) - 0.6; };
  const auto db = [&](Point p) { return polygon_distance(box, p); };
  using Kind = Shape::Kind;
  expect_distances(combined(Kind::Union, {a, b}), 1.5, [&](Point p) { return std::min(da(p), db(p)); });
  expect_distances(combined(Kind::Intersection, {a, b}), 1.5, [&](Point p) { return std::max(da(p), db(p)); });
  expect_distances(combined(Kind::Difference, {a, b}), 1.5, [&](Point p) { return std::max(da(p), -db(p)); });
  const auto smooth = [](double x, double y) {
    const double h = std::max(0.3 - std::abs(x - y), 0.0);
    return std::min(x, y) - h * h / 1.2;
  };
  expect_distances(combined(Kind::SmoothUnion, {a, b}, 0.3), 1.5, [&](Point p) { return smooth(da(p), db(p)); });
  expect_distances(combined(Kind::SmoothIntersection, {a, b}, 0.3), 1.5,
                   [&](Point p) { return -smooth(-da(p), -db(p)); });
  expect_distances(combined(Kind::SmoothDifference, {a, b}, 0.3), 1.5, [&](Point p) { return -smooth(-da(p), db(p)); });
  expect_distances(modified(Kind::Offset, 0.2, b), 1.5, [&](Point p) { return db(p) - 0.2; });
  expect_distances(modified(Kind::Border, 0.2, b), 1.5, [&](Point p) { return std::abs(db(p)) - 0.1; });
  expect_distances(modified(Kind::Complement, 0, b), 1.5, [&](Point p) { return -db(p); });
  // Turned by a right angle clockwise, (x, y) is at (-y, x); then twice as large and mirrored.
  expect_distances(rotated(90, b), 1.5, [&](Point p) { return db({p.y, -p.x}); });
  expect_distances(mapped({.is_mirrored = true, .scale = 1.5}, rotated(90, b)), 1.5, [&](Point p) {
    return 1.5 * db({-p.y / 1.5, -p.x / 1.5});
  });
}

// The distance to the nearest of all copies, which a union of them gives.
TEST(SdfShape, RepetitionsAreUnionsOfCopies) {
  const Point corners[] = {{-0.1, -0.06}, {0.1, -0.06}, {0.1, 0.06}, {-0.1, 0.06}};
  const ShapePtr one = rectangle(0.2, 0.12);
  const auto nearest = [&](Point p, int columns, int rows) {
    double best = 1e300;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const Point at{(i - (columns - 1) / 2.0) * 0.25, (j - (rows - 1) / 2.0) * 0.5};
        best = std::min(best, polygon_distance(corners, p - at));
      }
    return best;
  };
  expect_distances(repeated({0.25, 0.5}, 4, 3, one), 1, [&](Point p) { return nearest(p, 4, 3); });
  expect_distances(repeated({0.25, 0}, 3, 0, one), 1, [&](Point p) { return nearest(p, 3, 1); });
  expect_distances(repeated({0.25, 0.5}, 0, 0, one), 1, [&](Point p) { return nearest(p, 15, 9); });
}

/// Every kind of instruction in one shape.
ShapePtr everything() {
  using Kind = Shape::Kind;
  const ShapePtr rings = repeated({0.5, 0.6}, 3, 0, modified(Kind::Border, 0.05, circle(0.2)));
  const ShapePtr soft = combined(Kind::SmoothUnion, {rotated(20, ellipse(0.8, 0.3)), region(curved())}, 0.2);
  const ShapePtr cut = combined(Kind::SmoothDifference, {soft, moved({0.2, 0.1}, rectangle(0.4, 0.3))}, 0.1);
  const ShapePtr bounded = combined(Kind::SmoothIntersection, {cut, modified(Kind::Complement, 0, circle(0.1))}, 0.1);
  return combined(Kind::Difference, {combined(Kind::Union, {bounded, modified(Kind::Offset, 0.05, rings)}),
                                     combined(Kind::Intersection, {rhombus(0.5, 0.5), circle(0.2)})});
}

TEST(SdfShape, GradientsAreThoseOfTheDistances) {
  const Raster raster{256, 256, {-1.3, -1.3}, 256 / 2.6};
  const DistanceField field = distance_field(everything(), raster);
  int compared = 0;
  for (int y = 1; y < 255; ++y)
    for (int x = 1; x < 255; ++x) {
      const auto d = [&](int i, int j) { return static_cast<double>(field.distance(x + i, y + j)); };
      const double left = d(0, 0) - d(-1, 0), right = d(1, 0) - d(0, 0), up = d(0, 0) - d(0, -1),
                   down = d(0, 1) - d(0, 0);
      if (std::abs(left - right) > 1e-4 || std::abs(up - down) > 1e-4) continue;  // a crease, or a sharp bend
      EXPECT_NEAR(field.gradient_x(x, y), (left + right) / 2 * raster.scale, 0.03) << x << ' ' << y;
      EXPECT_NEAR(field.gradient_y(x, y), (up + down) / 2 * raster.scale, 0.03) << x << ' ' << y;
      ++compared;
    }
  EXPECT_GT(compared, 10'000);
}

TEST(SdfShape, InstructionSetsGiveTheSameBits) {
  const Raster raster{200, 120, {-1.3, -0.8}, 75};
  const DistanceField expected = with_isa(Isa::Scalar, [&] { return distance_field(everything(), raster); });
  for (const Isa isa : supported_isas()) {
    const DistanceField found = with_isa(isa, [&] { return distance_field(everything(), raster); });
    EXPECT_EQ(found.distance, expected.distance) << name_of(isa);
    EXPECT_EQ(found.gradient_x, expected.gradient_x) << name_of(isa);
    EXPECT_EQ(found.gradient_y, expected.gradient_y) << name_of(isa);
  }
}

}  // namespace
}  // namespace zoneplate::sdf
