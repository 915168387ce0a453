// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "zoneplate/sdf/outline.h"

namespace zoneplate::sdf {

struct Shape;
using ShapePtr = std::shared_ptr<const Shape>;

/// A region of the plane with its signed distance: negative inside, 0 on the boundary.
///
/// Exact     circle, ellipse, rectangle and outline; unions outside of the region, intersections and differences inside
///           of it, and the operations that map one exact distance. Elsewhere the value is a lower bound of the
///           magnitude of the distance, and nowhere does it change by more than the distance between two points.
struct Shape {
  enum class Kind {
    Circle,     ///< a: radius
    Ellipse,    ///< a, b: radii along x and y
    Rectangle,  ///< a, b: half width and half height
    Region,     ///< inside `outline`
    Union,
    Intersection,
    Difference,  ///< the first operand without the others
    SmoothUnion,
    SmoothIntersection,
    SmoothDifference,  ///< a: width of the rounded joint
    Offset,            ///< grown by a, so that corners are rounded; shrunk if a is negative
    Border,            ///< points within a / 2 of the boundary
    Complement,
    Mapped,  ///< the image of the operand under `map`
    Repeat,  ///< copies a apart along x and b along y (0: one); at most count_x × count_y of them (0: no limit)
  };
  Kind kind = Kind::Circle;
  double a = 0, b = 0;
  int count_x = 0, count_y = 0;
  Similarity map;
  std::shared_ptr<const Outline> outline;
  std::vector<ShapePtr> operands;

  // Found when the shape is made, from those of its operands.
  /// A rectangle outside of which the distance is positive; infinite for a complement.
  Bounds bounds{};
  /// The number of operations within operations, at most `deepest`: functions may recurse to the operands.
  int depth = 0;
  /// A lower bound of the number of instructions that evaluate the shape, even if operands are shared.
  std::size_t min_instructions = 1;

  /// Of a repetition: the number of columns and rows near a point, whose copies may be nearest to it.
  int columns() const { return a > 0 ? 2 : 1; }
  int rows() const { return b > 0 ? 2 : 1; }

  static constexpr int deepest = 64;
  static constexpr std::size_t max_instructions = std::size_t{1} << 20;  ///< of one shape
};

// All functions that make shapes throw ErrorKind::Input for operations that are nested more than Shape::deepest deep,
// or that need more than Shape::max_instructions. A shape may be an operand of several others.

// Closed shapes, with their centre at the origin.

ShapePtr circle(double radius);
ShapePtr ellipse(double radius_x, double radius_y);
ShapePtr rectangle(double width, double height);
/// The rhombus with diagonals of these lengths along the axes.
ShapePtr rhombus(double width, double height);
/// The isosceles trapezoid with these horizontal sides, the upper one first.
ShapePtr trapezoid(double top, double bottom, double height);
/// The isosceles triangle that points upwards; its centre is half way up.
ShapePtr triangle(double base, double height);
/// The regular polygon of at least three corners on a circle of this radius, one of them at the top.
ShapePtr regular_polygon(double radius, int corners);
ShapePtr region(Outline outline);

/// Joins the operands of a union, intersection or difference; `smoothness` is the width of the rounded joint.
ShapePtr combined(Shape::Kind kind, std::vector<ShapePtr> operands, double smoothness = 0);
/// An operation of one operand and one number.
ShapePtr modified(Shape::Kind kind, double amount, ShapePtr operand);
ShapePtr mapped(const Similarity& map, ShapePtr operand);
ShapePtr moved(Point by, ShapePtr operand);
/// A rotation about the origin, clockwise on the screen.
///
/// Exact     multiples of 90° exchange and negate coordinates only.
ShapePtr rotated(double degrees, ShapePtr operand);
ShapePtr repeated(Point step, int count_x, int count_y, ShapePtr operand);

}  // namespace zoneplate::sdf
