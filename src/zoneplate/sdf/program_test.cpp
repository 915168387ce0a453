// SPDX-License-Identifier: Apache-2.0
// Shapes that share operands, deep and long ones, and the selection of the parts of outlines.
#include "zoneplate/sdf/program.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"
#include "zoneplate/math/random.h"
#include "zoneplate/sdf/draw.h"
#include "zoneplate/sdf/evaluate.h"

namespace zoneplate::sdf {
namespace {

using Kind = Shape::Kind;

double random_number(std::uint32_t i, std::uint32_t k) { return static_cast<double>(unit_float(hash(i, k))); }

std::string message_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SdfProgram, ChainsEndAtTheGreatestDepth) {
  ShapePtr shape = circle(1);
  for (int i = 0; i < Shape::deepest; ++i) shape = modified(Kind::Offset, 0.001, shape);
  EXPECT_EQ(shape->depth, Shape::deepest);
  EXPECT_NEAR(shape->bounds.high.x, 1.064, 1e-9);
  EXPECT_EQ(message_of([&] { modified(Kind::Offset, 0, shape); }), "operations are nested more than 64 deep");
}

TEST(SdfProgram, RepetitionsThatNeedTooMuchAreRefusedWhenTheyAreMade) {
  ShapePtr shape = circle(1);
  const auto nest = [&] {
    for (int i = 0; i < 30; ++i) shape = repeated({3, 3}, 0, 0, shape);
  };
  EXPECT_EQ(message_of(nest), "the shape has more than 1048576 instructions");
  EXPECT_LT(shape->depth, 11);  // 4^10 copies
}

// Every operand is a combination of the one before with itself: a tree of 2^60 operations.
TEST(SdfProgram, SharedOperandsAreEvaluatedOnce) {
  ShapePtr shape = moved({1, 2}, circle(1));
  for (int i = 0; i < 60; ++i) shape = combined(Kind::Union, {shape, shape});
  Program program;
  const ShapeCode code = program.add(shape);
  EXPECT_EQ(code.end - code.first, 1 + 60 * 3u);  // the circle; to keep, to load and to join
  EXPECT_EQ(program.slots(), 1);
  const Point points[] = {{1, 2}, {4, 6}};
  EXPECT_EQ(distances_at(shape, points), (std::vector<float>{-1, 4}));
}

TEST(SdfProgram, AShapeThatIsAddedAgainIsNotCompiledAgain) {
  const ShapePtr shape = combined(Kind::Union, {circle(1), rectangle(3, 1)});
  const ShapePtr name = shape;  // a shape that nothing else refers to cannot be added again
  Program program;
  const ShapeCode first = program.add(shape), second = program.add(shape);
  EXPECT_EQ(program.instructions().size(), 3u);
  EXPECT_EQ(second.first, first.first);
}

/// The same shape with and without operands that are shared: at equal and at different coordinates, in the cells of a
/// repetition and outside of them.
ShapePtr with_operands(const std::function<ShapePtr()>& operand) {
  const ShapePtr inner = combined(Kind::Difference, {operand(), modified(Kind::Offset, -0.05, operand())});
  const ShapePtr other = repeated({0.7, 0.6}, 3, 2, combined(Kind::SmoothUnion, {operand(), operand()}, 0.1));
  return combined(Kind::Union, {inner, moved({0.1, 0.3}, operand()), other, operand()});
}

TEST(SdfProgram, SharedOperandsHaveTheSameBits) {
  const auto make = [] {
    return combined(Kind::SmoothUnion, {rotated(20, ellipse(0.4, 0.2)), rhombus(0.5, 0.7)}, 0.1);
  };
  const ShapePtr shared = make();
  const Raster raster{150, 100, {-1.3, -0.9}, 56};
  const DistanceField expected = distance_field(with_operands(make), raster);
  const DistanceField found = distance_field(with_operands([&] { return shared; }), raster);
  EXPECT_EQ(found.distance, expected.distance);
  EXPECT_EQ(found.gradient_x, expected.gradient_x);
  EXPECT_EQ(found.gradient_y, expected.gradient_y);
  Program program, larger;
  EXPECT_LT(program.add(with_operands([&] { return shared; })).end, larger.add(with_operands(make)).end);
}

/// An outline of long lines and curves across the square [0, 100)².
Outline tangle(int segments) {
  Outline outline;
  Pen pen(outline);
  const auto point = [](int i, std::uint32_t k) {
    const auto n = static_cast<std::uint32_t>(i);
    return Point{100 * random_number(n, k), 100 * random_number(n, k + 1)};
  };
  pen.move_to(point(0, 0));
  for (int i = 1; i < segments; ++i)
    i % 3 == 0 ? pen.cubic_to(point(i, 2), point(i, 4), point(i, 0)) : pen.line_to(point(i, 0));
  pen.close();
  return outline;
}

// A drawing selects parts for a tile and then for its blocks, distances_at from all parts for its points, and points
// that are far from each other select nearly all.
TEST(SdfProgram, SelectedPartsGiveTheSameBits) {
  const ShapePtr shape = moved({3, 5}, region(tangle(300)));
  const Raster raster{150, 140, {-10, -10}, 1.1};
  const DistanceField field = distance_field(shape, raster);
  std::vector<Point> points;
  constexpr int step = 37, side = 150 * 140;  // neighbours in a batch are rows apart
  for (int i = 0; i < side; ++i)
    points.push_back(raster.centre(i * step % side % raster.width, i * step % side / raster.width));
  const std::vector<float> distances = distances_at(shape, points);
  for (int i = 0; i < side; ++i)
    ASSERT_EQ(field.distance(i * step % side % raster.width, i * step % side / raster.width),
              distances[static_cast<std::size_t>(i)]);
}

// Their bounds overlap: that of every third line contains a block's middle.
TEST(SdfProgram, FewOfManyLongLinesAreNearABlock) {
  constexpr int count = 30'000;
  std::vector<Point> corners;
  for (std::uint32_t i = 0; i < count; ++i) corners.push_back({1000 * random_number(i, 1), 1000 * random_number(i, 2)});
  Program program;
  program.add(region(polygon(corners)));
  PieceSelection selection;
  select_pieces(program, program.instructions()[0], {100, 108, 50, 58}, selection);
  EXPECT_GT(selection.near.size(), 50u);
  EXPECT_LT(selection.near.size(), 1000u);
  EXPECT_LT(selection.beside.size(), 1000u);
}

}  // namespace
}  // namespace zoneplate::sdf
