// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::sdf {
namespace {

Bounds bounds_of(const Shape& shape) {
  using Kind = Shape::Kind;
  const double a = shape.a, b = shape.b;
  const auto of = [&](std::size_t i) { return shape.operands[i]->bounds; };
  switch (shape.kind) {
    case Kind::Circle:
      return {{-a, -a}, {a, a}};
    case Kind::Ellipse:
    case Kind::Rectangle:
      return {{-a, -b}, {a, b}};
    case Kind::Region:
      return shape.outline->bounds();
    case Kind::Union:
    case Kind::SmoothUnion: {
      Bounds all;
      for (const ShapePtr& operand : shape.operands) all.add(operand->bounds);
      // The joint of n operands is at most a quarter of its width above each.
      return shape.kind == Kind::Union ? all : all.grown(a / 4 * static_cast<double>(shape.operands.size() - 1));
    }
    case Kind::Intersection:
    case Kind::SmoothIntersection: {
      Bounds all = of(0);
      for (const ShapePtr& operand : shape.operands) all = common(all, operand->bounds);
      return all;
    }
    case Kind::Difference:
    case Kind::SmoothDifference:
      return of(0);
    case Kind::Offset:
      return of(0).grown(a);
    case Kind::Border:
      return of(0).grown(a / 2);
    case Kind::Complement:
      return Bounds::everything();
    case Kind::Mapped:
      return shape.map(of(0));
    case Kind::Repeat: {
      const Bounds one = of(0);
      if (!one.is_finite() || one.empty()) return one;
      const double far = std::numeric_limits<double>::infinity();
      const auto reach = [&](double step, int count) {
        return step == 0 ? 0 : count == 0 ? far : step * (count - 1) / 2.0;
      };
      const Point r{reach(a, shape.count_x), reach(b, shape.count_y)};
      return {one.low - r, one.high + r};
    }
  }
  return Bounds::everything();
}

ShapePtr make(Shape shape) {
  std::size_t instructions = 1;
  for (const ShapePtr& operand : shape.operands) {
    shape.depth = std::max(shape.depth, operand->depth + 1);
    instructions = std::max(instructions, operand->min_instructions + (shape.kind != Shape::Kind::Mapped));
  }
  if (shape.kind == Shape::Kind::Repeat) instructions *= static_cast<std::size_t>(shape.columns() * shape.rows());
  if (shape.depth > Shape::deepest)
    throw Error(ErrorKind::Input, fmt::format("operations are nested more than {} deep", Shape::deepest));
  if (instructions > Shape::max_instructions)
    throw Error(ErrorKind::Input, fmt::format("the shape has more than {} instructions", Shape::max_instructions));
  shape.min_instructions = instructions;
  shape.bounds = bounds_of(shape);
  return std::make_shared<const Shape>(std::move(shape));
}

ShapePtr convex(std::initializer_list<Point> corners) {
  return region(polygon(std::span(corners.begin(), corners.size())));
}

}  // namespace

ShapePtr circle(double radius) { return make({.kind = Shape::Kind::Circle, .a = radius}); }
ShapePtr ellipse(double radius_x, double radius_y) {
  return make({.kind = Shape::Kind::Ellipse, .a = radius_x, .b = radius_y});
}
ShapePtr rectangle(double width, double height) {
  return make({.kind = Shape::Kind::Rectangle, .a = width / 2, .b = height / 2});
}
ShapePtr rhombus(double width, double height) {
  return convex({{0, -height / 2}, {width / 2, 0}, {0, height / 2}, {-width / 2, 0}});
}
ShapePtr trapezoid(double top, double bottom, double height) {
  return convex({{-top / 2, -height / 2}, {top / 2, -height / 2}, {bottom / 2, height / 2}, {-bottom / 2, height / 2}});
}
ShapePtr triangle(double base, double height) {
  return convex({{0, -height / 2}, {base / 2, height / 2}, {-base / 2, height / 2}});
}
ShapePtr regular_polygon(double radius, int corners) {
  assert(corners >= 3);
  std::vector<Point> points;
  for (int i = 0; i < corners; ++i) {
    const SineCosine root = unit_root(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(corners));
    points.push_back({radius * root.sine, -radius * root.cosine});
  }
  return region(polygon(points));
}
ShapePtr region(Outline outline) {
  return make({.kind = Shape::Kind::Region, .outline = std::make_shared<const Outline>(std::move(outline))});
}

ShapePtr combined(Shape::Kind kind, std::vector<ShapePtr> operands, double smoothness) {
  assert(!operands.empty());
  return make({.kind = kind, .a = smoothness, .operands = std::move(operands)});
}
ShapePtr modified(Shape::Kind kind, double amount, ShapePtr operand) {
  return make({.kind = kind, .a = amount, .operands = {std::move(operand)}});
}
ShapePtr mapped(const Similarity& map, ShapePtr operand) {
  return make({.kind = Shape::Kind::Mapped, .map = map, .operands = {std::move(operand)}});
}
ShapePtr moved(Point by, ShapePtr operand) { return mapped({.move = by}, std::move(operand)); }
ShapePtr rotated(double degrees, ShapePtr operand) {
  const SineCosine turn = sin_cos_pi(degrees / 180);
  return mapped({.cosine = turn.cosine, .sine = turn.sine}, std::move(operand));
}
ShapePtr repeated(Point step, int count_x, int count_y, ShapePtr operand) {
  return make({.kind = Shape::Kind::Repeat,
               .a = step.x,
               .b = step.y,
               .count_x = count_x,
               .count_y = count_y,
               .operands = {std::move(operand)}});
}

}  // namespace zoneplate::sdf
