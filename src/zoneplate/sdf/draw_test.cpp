// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/draw.h"

#include <gtest/gtest.h>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/hash_for_test.h"
#include "zoneplate/math/random.h"
#include "zoneplate/sdf/exact_coverage.h"

namespace zoneplate::sdf {
namespace {

double max_difference(const Plane<float>& a, const Plane<float>& b) {
  double greatest = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    greatest = std::max(greatest, std::abs(static_cast<double>(a.values()[i]) - static_cast<double>(b.values()[i])));
  return greatest;
}

// A half-plane, as a large triangle turned by every whole degree and moved by parts of a pixel.
TEST(SdfDraw, StraightEdgesHaveTheirExactArea) {
  const Raster raster{32, 32, {}, 1};
  double worst = 0;
  for (int degrees = 0; degrees < 360; ++degrees) {
    const float part = unit_float(hash(static_cast<std::uint32_t>(degrees)));
    const Point corners[] = {{-900, 0}, {900, 0}, {0, 900}};
    const Similarity move{.move = {16 + static_cast<double>(part), 15.5}};
    const ShapePtr turned = mapped(move, rotated(degrees, region(polygon(corners))));
    const Similarity whole = move * turned->operands[0]->map;
    worst = std::max(
        worst, max_difference(coverage_of(turned, raster), exact_coverage(polygon(corners).mapped(whole), raster)));
  }
  EXPECT_LT(worst, 1.0 / 255 / 16);
}

TEST(SdfDraw, ExactCoverageAddsUpToTheArea) {
  const Point corners[] = {{3.25, 2.5}, {17.75, 5.125}, {9.5, 18.875}};
  const Plane<float> whole = exact_coverage(polygon(corners), {24, 24, {}, 1});
  double area = 0;
  for (const float c : whole.values()) area += static_cast<double>(c);
  EXPECT_NEAR(area, cross(corners[1] - corners[0], corners[2] - corners[0]) / 2, 1e-5);
  // What is left of the image counts, what is right of it does not.
  const Point box[] = {{-5, -5}, {4.5, -5}, {4.5, 40}, {-5, 40}};
  const Plane<float> cut = exact_coverage(polygon(box), {8, 2, {}, 1});
  for (int x = 0; x < 8; ++x) EXPECT_EQ(cut(x, 1), x < 4 ? 1.0f : x == 4 ? 0.5f : 0.0f);
}

// The area between an arc of radius r and its tangent, over the diagonal of a square of side a, is (√2 a)³ / 24r; with
// n × n squares in a pixel, that is 0.118 / n r of the pixel at most.
TEST(SdfDraw, CurvedEdgesHaveASmallError) {
  for (const double radius : {2.0, 4.0, 8.0, 16.0, 64.0}) {
    const int side = static_cast<int>(2 * radius + 6);
    const Point c{side / 2.0 + 0.3, side / 2.0 + 0.1};
    Plane<float> exact;
    {
      // 64 cubics, which are within 1e-9 of the arcs.
      Outline outline;
      Pen pen(outline);
      constexpr int arcs = 64;
      const auto at = [&](int i) {
        const double angle = 2 * 3.14159265358979 * i / arcs;
        return Point{c.x + radius * std::cos(angle), c.y + radius * std::sin(angle)};
      };
      const double k = 4.0 / 3 * std::tan(3.14159265358979 / 2 / arcs);
      pen.move_to(at(0));
      for (int i = 0; i < arcs; ++i) {
        const Point a = at(i), b = at(i + 1), ra = a - c, rb = b - c;
        pen.cubic_to(a + Point{-ra.y, ra.x} * k, b - Point{-rb.y, rb.x} * k, b);
      }
      pen.close();
      exact = exact_coverage(outline, {side, side, {}, 1});
    }
    const double one = max_difference(coverage_of(moved(c, circle(radius)), {side, side, {}, 1}), exact);
    const double sixteen = max_difference(coverage_of(moved(c, circle(radius)), {side, side, {}, 1}, 4), exact);
    EXPECT_LT(one, 0.118 / radius + 1e-4) << radius;
    EXPECT_LT(sixteen, 0.118 / 4 / radius + 1e-4) << radius;
    RecordProperty("r" + std::to_string(static_cast<int>(radius)), std::to_string(one) + " " + std::to_string(sixteen));
  }
}

/// Overlapping shapes of many sizes, and one that repeats over the whole image.
Drawing crowd(int count, int side) {
  Drawing drawing;
  const auto random = [](int i, std::uint32_t axis) {
    return static_cast<double>(unit_float(hash(static_cast<std::uint32_t>(i), axis)));
  };
  drawing.fill(repeated({40, 30}, 0, 0, rotated(30, rectangle(12, 6))), {0.1f, 0.1f, 0.3f, 1});
  for (int i = 0; i < count; ++i) {
    const double size = 2 + 40 * random(i, 3) * random(i, 4);
    const ShapePtr shapes[] = {circle(size), rotated(360 * random(i, 5), rectangle(size, size / 2)),
                               regular_polygon(size, 5), ellipse(size, size / 3),
                               modified(Shape::Kind::Border, 1.5, triangle(size, size))};
    const float alpha = 0.5f + 0.5f * static_cast<float>(random(i, 6));
    drawing.fill(
        moved({side * random(i, 1), side * random(i, 2)}, shapes[i % 5]),
        {alpha * static_cast<float>(random(i, 7)), alpha * static_cast<float>(random(i, 8)), alpha * 0.5f, alpha});
  }
  return drawing;
}

// Every pixel of an image of several tiles is that of an image that has the pixel in a tile's first block.
TEST(SdfDraw, HasNoHolesBetweenTiles) {
  const Drawing drawing = crowd(300, 200);
  const LinearImage whole = draw(drawing, {200, 200, {}, 1}, {0, 0, 0, 1});
  for (const int move : {3, 8, 61}) {
    const LinearImage part = draw(
        drawing, {200 - move, 200 - move, {static_cast<double>(move), static_cast<double>(move)}, 1}, {0, 0, 0, 1});
    for (int y = 0; y < part.height(); ++y)
      for (int x = 0; x < part.width(); ++x)
        ASSERT_EQ(part(x, y), whole(x + move, y + move)) << x << ' ' << y << ' ' << move;
  }
}

TEST(SdfDraw, ThreadsAndInstructionSetsGiveTheSameBits) {
  const Drawing drawing = crowd(100, 200);
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 3})
      with_threads(threads, [&] {
        const LinearImage image = with_isa(isa, [&] { return draw(drawing, {200, 150, {}, 1}, {1, 1, 1, 1}, 2); });
        EXPECT_EQ(hash_of(image), 0xfa672ee3ad75baadu) << name_of(isa);
      });
}

}  // namespace
}  // namespace zoneplate::sdf
