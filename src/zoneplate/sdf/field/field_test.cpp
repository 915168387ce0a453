// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "zoneplate/math/random.h"
#include "zoneplate/sdf/exact_coverage.h"
#include "zoneplate/sdf/field/atlas.h"
#include "zoneplate/sdf/field/distance_transform.h"
#include "zoneplate/sdf/field/field_image.h"

namespace zoneplate::sdf {
namespace {

Plane<std::uint8_t> noise(int width, int height, std::uint32_t seed, unsigned one_in) {
  Plane<std::uint8_t> mask(width, height);
  for (std::size_t i = 0; i < mask.values().size(); ++i)
    mask.values()[i] = hash(static_cast<std::uint32_t>(i), seed) % one_in == 0;
  return mask;
}

TEST(SdfTransform, IsExactAgainstEveryPair) {
  for (const unsigned one_in : {2u, 7u, 60u, 2000u})
    for (const auto& [width, height] : {std::pair{61, 37}, {1, 50}, {50, 1}, {16, 16}}) {
      const Plane<std::uint8_t> mask = noise(width, height, one_in, one_in);
      const Plane<std::int32_t> found = squared_distances(mask);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          std::int32_t best = infinitely_far;
          for (int j = 0; j < height; ++j)
            for (int i = 0; i < width; ++i)
              if (mask(i, j)) best = std::min(best, (i - x) * (i - x) + (j - y) * (j - y));
          ASSERT_EQ(found(x, y), best) << width << ' ' << x << ' ' << y;
        }
    }
}

TEST(SdfTransform, FieldGivesTheMaskBack) {
  const Plane<std::uint8_t> mask = noise(80, 60, 5, 3);
  const Plane<float> field = signed_distances(mask);
  const Plane<float> drawn = drawn_field(field, 80, 60, 1);
  for (std::size_t i = 0; i < mask.values().size(); ++i) {
    EXPECT_EQ(field.values()[i] < 0, mask.values()[i] != 0);
    EXPECT_EQ(drawn.values()[i] > 0.5f, mask.values()[i] != 0);
  }
  // A straight edge between two pixels is where it was, also enlarged.
  Plane<std::uint8_t> half(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 7; ++x) half(x, y) = 1;
  const Plane<float> large = drawn_field(signed_distances(half), 64, 64, 4);
  for (int x = 0; x < 64; ++x) EXPECT_EQ(large(x, 30), x < 28 ? 1.0f : 0.0f) << x;
}

/// A square with a notch: corners of both kinds, and a curve.
Outline notched() {
  Outline outline;
  Pen pen(outline);
  pen.move_to({0.1, -0.1});
  pen.line_to({0.1, -0.7});
  pen.line_to({0.4, -0.4});
  pen.line_to({0.7, -0.7});
  pen.quadratic_to({0.9, -0.4}, {0.7, -0.1});
  pen.close();
  return outline;
}

TEST(SdfField, NeighboursAtACornerShareOneChannel) {
  Outline outline = notched();
  const std::vector<unsigned> channels = color_edges(outline.contours[0]);
  ASSERT_EQ(channels.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(std::popcount(channels[i] & channels[(i + 1) % 5]), 1) << i;
  Contour drop;
  {
    Outline one;
    Pen pen(one);
    pen.move_to({0, 0});
    pen.cubic_to({1, 1}, {-1, 1}, {0, 0});
    pen.close();
    drop = one.contours[0];
  }
  const std::vector<unsigned> thirds = color_edges(drop);
  EXPECT_EQ(thirds.size(), drop.size());
  EXPECT_GE(drop.size(), 3u);
  EXPECT_EQ(std::popcount(thirds.front() & thirds.back()), 1);
}

double max_error(const Plane<float>& a, const Plane<float>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(a.values()[i]) - static_cast<double>(b.values()[i])));
  return worst;
}

double rms_error(const Plane<float>& a, const Plane<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    sum += std::pow(static_cast<double>(a.values()[i]) - static_cast<double>(b.values()[i]), 2);
  return std::sqrt(sum / static_cast<double>(a.values().size()));
}

// Enlarged eight times, a single channel rounds corners, three keep them.
TEST(SdfField, ThreeChannelsKeepCorners) {
  constexpr int side = 24, factor = 8;
  const Outline shape = notched();
  const Plane<float> exact =
      exact_coverage(shape, {side * factor, side * factor, {-4.0 / side, -20.0 / side}, side * factor / 1.0});
  double error[2];
  int i = 0;
  for (const FieldKind kind : {FieldKind::Single, FieldKind::Multi}) {
    const FieldImage field = outline_field(shape, kind, side, side, side, {4, 20}, 4);
    Plane<float> drawn(side * factor, side * factor);
    field.add_coverage(drawn, {}, factor);
    error[i++] = rms_error(drawn, exact);
  }
  EXPECT_LT(error[1], error[0] / 2) << error[0];
  EXPECT_LT(error[1], 0.02);
}

/// Closed polygons.
Outline polygons(std::initializer_list<std::initializer_list<Point>> contours) {
  Outline out;
  for (const auto& points : contours)
    for (Contour& contour : polygon(std::vector<Point>(points)).contours) out.contours.push_back(std::move(contour));
  return out;
}

// Two bars that cross, the same with opposite directions, and one contour that overlaps itself, as variable fonts have
// them: the ink of an atlas of 32 texels per em.
TEST(SdfAtlas, OverlappingContoursKeepTheirInk) {
  struct Case {
    Outline outline;
    double area, part;  // em², and the part of it that may be lost
  };
  const Case cases[] = {
      {polygons({{{0.1, -0.3}, {0.1, -0.5}, {0.9, -0.5}, {0.9, -0.3}}, {{0.4, 0}, {0.4, -0.8}, {0.6, -0.8}, {0.6, 0}}}),
       0.28, 0.002},
      // Four squares whose corners touch, at which no median of three channels is right.
      {polygons({{{0.1, -0.3}, {0.1, -0.5}, {0.9, -0.5}, {0.9, -0.3}}, {{0.6, 0}, {0.6, -0.8}, {0.4, -0.8}, {0.4, 0}}}),
       0.24, 0.01},
      {polygons({{{0.1, 0}, {0.1, -0.7}, {0.7, -0.7}, {0.7, -0.3}, {0.3, -0.3}, {0.3, -0.9}, {0.5, -0.9}, {0.5, 0}}}),
       0.40, 0.002}};
  for (const Case& c : cases) {
    const std::vector<GlyphOutline> glyphs = {{U'a', 1, c.outline}};
    const Atlas atlas = make_atlas(glyphs, {.kind = FieldKind::Multi, .size = 32, .range = 4});
    constexpr double em = 200;
    const char32_t text[] = {U'a'};
    Plane<float> drawn(220, 220);
    draw_text(atlas, text, {10, 200}, em, drawn);
    double ink = 0;
    for (const float v : drawn.values()) ink += static_cast<double>(v);
    EXPECT_NEAR(ink / (em * em), c.area, c.area * c.part);
  }
}

TEST(SdfAtlas, DrawsGlyphsWhereTheirOutlinesAre) {
  const std::vector<GlyphOutline> glyphs = {{U'a', 0.9, notched()}, {U' ', 0.4, {}}, {U'b', 0.8, notched()}};
  for (const FieldKind kind : {FieldKind::Single, FieldKind::Multi, FieldKind::MultiAlpha}) {
    const Atlas atlas = make_atlas(glyphs, {.kind = kind, .size = 32, .range = 4});
    EXPECT_LE(atlas.field.distances.height(), atlas.field.distances.width());
    const char32_t text[] = {U'a', U' ', U'b'};
    constexpr double em = 64;
    Plane<float> drawn(160, 70);
    draw_text(atlas, text, {3.25, 60.5}, em, drawn);
    Outline both = notched().mapped({.scale = em, .move = {3.25, 60.5}});
    for (Contour& c : notched().mapped({.scale = em, .move = {3.25 + 1.3 * em, 60.5}}).contours)
      both.contours.push_back(c);
    const Plane<float> exact = exact_coverage(both, {160, 70, {}, 1});
    EXPECT_LT(rms_error(drawn, exact), 0.025);
    EXPECT_LT(max_error(drawn, exact), kind == FieldKind::Single ? 0.8 : 0.45);
  }
}

}  // namespace
}  // namespace zoneplate::sdf
