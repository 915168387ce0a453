// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/clip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/raster/geometry/setup.h"

namespace zoneplate {
namespace {

constexpr Viewport clip_viewport{640, 480};

float4 random_vertex(std::uint32_t seed) {
  const auto at = [&](std::uint32_t axis, float range) { return (unit_float(hash(seed, axis)) * 2 - 1) * range; };
  const float scale = std::exp2(at(0, 8));
  return {at(1, 4) * scale, at(2, 4) * scale, at(3, 1.5f), at(4, 2)};
}

std::int64_t area(const ClippedPolygon& p) {
  std::int64_t sum = 0;
  for (int i = 2; i < p.count; ++i)
    sum += doubled_area(p.vertex[0], p.vertex[static_cast<std::size_t>(i - 1)], p.vertex[static_cast<std::size_t>(i)]);
  return sum;
}

TEST(Clip, WhatIsLeftLiesInsideEveryPlane) {
  int cut = 0, left = 0;
  for (std::uint32_t i = 0; i < 200000; ++i) {
    const ClippedPolygon p =
        clip_triangle(random_vertex(3 * i), random_vertex(3 * i + 1), random_vertex(3 * i + 2), clip_viewport);
    left += p.count >= 3;
    cut += p.count > 3;
    ASSERT_TRUE(p.count == 0 || (p.count >= 3 && p.count <= ClippedPolygon::capacity));
    for (int k = 0; k < p.count; ++k) {
      const ScreenVertex& v = p.vertex[static_cast<std::size_t>(k)];
      ASSERT_LE(std::abs(v.x), guard_band);
      ASSERT_LE(std::abs(v.y), guard_band);
      ASSERT_TRUE(v.z >= 0 && v.z <= 1 && v.inv_w > 0);
    }
  }
  EXPECT_GT(left, 10000);
  EXPECT_GT(cut, 5000);
}

TEST(Clip, NeighboursGetTheSameNewVertex) {
  // Triangles a b c and b a d share an edge: every new vertex on it is the same, bit for bit.
  int shared = 0;
  for (std::uint32_t i = 0; i < 50000; ++i) {
    const float4 a = random_vertex(4 * i), b = random_vertex(4 * i + 1);
    // Third corners far inside, so that only the shared edge is cut.
    const float4 c{0.3f, -0.2f, 0.5f, 1}, d{-0.4f, 0.25f, 0.5f, 1};
    const ClippedPolygon p = clip_triangle(a, b, c, clip_viewport), q = clip_triangle(b, a, d, clip_viewport);
    if (!p.count || !q.count || std::min(a.w, b.w) > 0) continue;
    int equal = 0;
    for (int j = 0; j < p.count; ++j)
      for (int k = 0; k < q.count; ++k) {
        const ScreenVertex &v = p.vertex[static_cast<std::size_t>(j)], &w = q.vertex[static_cast<std::size_t>(k)];
        equal += v.x == w.x && v.y == w.y && v.z == w.z;
      }
    // If one end is inside, the edge leaves that end and one cut in both.
    const bool a_in = !project(a, clip_viewport).needs_clipping(), b_in = !project(b, clip_viewport).needs_clipping();
    ASSERT_GE(equal, a_in != b_in ? 2 : 0) << i;
    shared += a_in != b_in;
  }
  EXPECT_GT(shared, 50);
}

TEST(Clip, PartsOfATriangleAddUp) {
  // A triangle through the far plane: what is left is the closed form's trapezoid.
  const float4 a{-0.5f, -0.5f, 0.5f, 1}, b{0.5f, -0.5f, 0.5f, 1}, c{0, 0.5f, -0.5f, 1};
  const ClippedPolygon p = clip_triangle(a, b, c, clip_viewport);
  ASSERT_EQ(p.count, 4);
  // Half the height is left: 3/4 of the area of 320 × 240 / 2 pixels.
  EXPECT_NEAR(static_cast<double>(std::abs(area(p))) / 2 / 65536, 0.75 * 320 * 240 / 2, 1);
  EXPECT_EQ(clip_triangle({-1, 0, 2, 1}, {1, 0, 2, 1}, {0, 1, 2, 1}, clip_viewport).count, 0);  // before the near plane
  EXPECT_EQ(clip_triangle({0, 0, 0.5f, -1}, {1, 0, 0.5f, -1}, {0, 1, 0.5f, -1}, clip_viewport).count,
            0);  // behind the eye
  EXPECT_EQ(clip_triangle({NAN, 0, 0.5f, 1}, b, c, clip_viewport).count, 0);
  EXPECT_EQ(clip_triangle({INFINITY, 0, 0.5f, 1}, b, c, clip_viewport).count, 0);
}

TEST(Project, KernelsGiveTheScalarTwinsBits) {
  std::vector<float3> p;
  for (std::uint32_t i = 0; i < 200; ++i) p.push_back({random_vertex(i).x, random_vertex(i).y, random_vertex(i).z * 3});
  float4x4 m;
  m.column = {
      {{1.1f, 0.1f, 0.02f, 0.01f}, {-0.2f, 0.9f, 0.03f, 0.3f}, {0.3f, 0.2f, -0.01f, -0.9f}, {0.1f, 0.2f, 0.3f, 0.4f}}};
  for (const Isa isa : supported_isas())
    for (std::size_t n = 0; n <= p.size(); ++n) {
      std::vector<ScreenVertex> expected(n + 1), actual(n + 1);
      ProjectKernels::scalar.transform(m, p.data(), n, clip_viewport, expected.data());
      ProjectKernels::of(isa).transform(m, p.data(), n, clip_viewport, actual.data());
      for (std::size_t i = 0; i <= n; ++i) {
        ASSERT_EQ(expected[i].x, actual[i].x) << name_of(isa);
        ASSERT_EQ(expected[i].y, actual[i].y);
        ASSERT_EQ(expected[i].z, actual[i].z);
        ASSERT_EQ(std::signbit(expected[i].z), std::signbit(actual[i].z));
        ASSERT_EQ(expected[i].inv_w, actual[i].inv_w);
      }
    }
}

}  // namespace
}  // namespace zoneplate
