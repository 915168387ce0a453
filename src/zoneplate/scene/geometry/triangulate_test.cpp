// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

double signed_area(const std::vector<float3>& p, const std::array<std::uint32_t, 3>& t, float3 normal) {
  const float3 c = cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]);
  return 0.5 * static_cast<double>(dot(c, normal));
}

/// A simple polygon is triangulated correctly if n - 2 triangles of its orientation have its area.
void expect_tiled(const std::vector<float3>& polygon) {
  Triangles triangles;
  EXPECT_TRUE(triangulate(polygon, triangles));
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  const std::array<double, 3> n = area_vector(polygon);
  const double twice = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  const float3 unit{static_cast<float>(n[0] / twice), static_cast<float>(n[1] / twice),
                    static_cast<float>(n[2] / twice)};
  double sum = 0;
  for (const auto& t : triangles) {
    const double area = signed_area(polygon, t, unit);
    EXPECT_GE(area, -1e-6 * twice);
    sum += std::abs(area);
  }
  EXPECT_NEAR(sum, twice / 2, 1e-5 * twice);
}

TEST(Triangulate, ConvexPolygonsAreFans) {
  Triangles triangles;
  EXPECT_TRUE(triangulate(std::vector<float3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, triangles));
  EXPECT_EQ(triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
  triangles.clear();
  EXPECT_TRUE(triangulate(std::vector<float3>{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, triangles));
  EXPECT_EQ(triangles, (Triangles{{0, 1, 2}}));
  triangles.clear();
  EXPECT_TRUE(triangulate(std::vector<float3>{{0, 0, 0}, {0, 1, 0}}, triangles));
  EXPECT_TRUE(triangles.empty());
}

TEST(Triangulate, ArrowsAreCutAtTheirNotchWhereverTheyBegin) {
  const std::vector<float3> arrow = {{0, 0, 0}, {2, -1, 0}, {0, 2, 0}, {-2, -1, 0}};
  for (std::size_t turn = 0; turn < 4; ++turn)
    for (const bool mirrored : {false, true})
      for (int axis = 0; axis < 3; ++axis) {
        std::vector<float3> polygon;
        for (std::size_t i = 0; i < 4; ++i) {
          const float3 p = arrow[(mirrored ? 8 - i + turn : i + turn) % 4];
          polygon.push_back(axis == 0 ? p : axis == 1 ? float3{p.z, p.x, p.y} : float3{p.y, p.z, p.x});
        }
        expect_tiled(polygon);
      }
}

TEST(Triangulate, StarsAndCombsAreTiled) {
  // Random star-shaped polygons about a centre, tilted relative to all coordinate planes.
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const std::uint32_t n = 4 + hash(seed) % 60;
    std::vector<float3> star;
    for (std::uint32_t i = 0; i < n; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(n);
      const float r = 0.2f + unit_float(hash(seed, i, 1));
      const float x = r * std::cos(angle), y = r * std::sin(angle);
      star.push_back({x + 0.3f * y, y - 0.5f * x, 0.7f * x + 0.2f * y + 5});
    }
    expect_tiled(star);
  }
  std::vector<float3> comb;
  for (int i = 0; i < 40; ++i) comb.push_back({static_cast<float>(i), i % 2 == 0 ? 1.0f : 9.0f, 2});
  comb.push_back({39, 0, 2});
  comb.push_back({20, 0, 2});  // a straight corner
  comb.push_back({0, 0, 2});
  expect_tiled(comb);
}

TEST(Triangulate, AnswersToAnyOutline) {
  // Corners that coincide, are collinear or intersect: the result always has n - 2 triangles.
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    const std::uint32_t n = 3 + hash(seed) % 12;
    std::vector<float3> polygon;
    for (std::uint32_t i = 0; i < n; ++i) {
      const auto grid = [&](std::uint32_t d) { return static_cast<float>(hash(seed, i, d) % 4); };
      polygon.push_back({grid(1), grid(2), seed % 2 == 0 ? 0 : grid(3)});
    }
    Triangles triangles;
    EXPECT_TRUE(triangulate(polygon, triangles));
    ASSERT_EQ(triangles.size(), n - 2);
    for (const auto& t : triangles)
      for (const std::uint32_t i : t) ASSERT_LT(i, n);
  }
}

TEST(Triangulate, BoundsItsWork) {
  std::vector<float3> comb;
  for (int i = 0; i < 20000; ++i) comb.push_back({static_cast<float>(i), i % 2 == 0 ? 1.0f : 9.0f, 0});
  comb.push_back({19999, -1, 0});
  comb.push_back({0, -1, 0});
  Triangles triangles;
  EXPECT_FALSE(triangulate(comb, triangles));
  EXPECT_EQ(triangles.size(), comb.size() - 2);
}

TEST(Triangulate, FindsTheEarsOfLongOutlinesButNotOfKnots) {
  constexpr std::uint32_t n = 4096;
  std::vector<float3> star, spiral, knot;
  for (std::uint32_t i = 0; i < n; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / n, r = 0.2f + unit_float(hash(i, 1));
    star.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    // Ten turns outwards and back, with a wall of half the distance between two turns.
    const float t = static_cast<float>(i < n / 2 ? i : n - 1 - i) / (n / 2), turn = 62.831853f * t;
    const float radius = 1 + 10 * t + (i < n / 2 ? 0 : 0.5f);
    spiral.push_back({radius * std::cos(turn), radius * std::sin(turn), 0});
    knot.push_back({unit_float(hash(i, 2)), unit_float(hash(i, 3)), 0});
  }
  for (const auto& [outline, has_ears] : {std::pair(star, true), {spiral, true}, {knot, false}}) {
    Triangles triangles;
    EXPECT_EQ(triangulate(outline, triangles), has_ears);
    EXPECT_EQ(triangles.size(), n - 2);
  }
}

}  // namespace
}  // namespace zoneplate
