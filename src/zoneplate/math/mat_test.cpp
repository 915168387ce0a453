// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/mat.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"

namespace zoneplate {
namespace {

float4x4 noise(std::uint32_t seed) {
  float4x4 m;
  std::uint32_t i = 0;
  for (float4& c : m.column) {
    const auto next = [&] { return unit_float(hash(seed, i++)) * 2 - 1; };
    c.x = next(), c.y = next(), c.z = next(), c.w = next();
  }
  return m;
}

void expect_near(const float4x4& a, const float4x4& b, float tolerance) {
  for (std::size_t c = 0; c < 4; ++c) {
    const float4 d = a.column[c] - b.column[c];
    EXPECT_LE(std::sqrt(dot(d, d)), tolerance) << "column " << c;
  }
}

TEST(Mat, ProductActsAsOneAfterTheOther) {
  // Small integers: every sum is exact in any order.
  const float4x4 a = {{float4{1, 2, 3, 4}, float4{5, 6, 7, 8}, float4{-1, 0, 2, 1}, float4{3, -2, 1, 0}}};
  const float4x4 b = {{float4{0, 1, 0, 2}, float4{2, 0, -1, 1}, float4{1, 1, 1, 1}, float4{4, 3, 2, 1}}};
  const float4 v = {1, -2, 3, 5};
  EXPECT_EQ((a * b) * v, a * (b * v));
  EXPECT_EQ(a * float4x4(), a);
  EXPECT_EQ(float4x4() * a, a);
  EXPECT_EQ(transpose(a * b), transpose(b) * transpose(a));
  EXPECT_EQ(a * v, (float4{1 * 1 - 5 * 2 - 1 * 3 + 3 * 5, 2 - 12 + 0 - 10, 3 - 14 + 6 + 5, 4 - 16 + 3 + 0}));
}

TEST(Mat, PointsAreMovedAndVectorsAreNot) {
  const float4x4 m = translation({1, 2, 3}) * scaling({2, 2, 2});
  EXPECT_EQ(transform_point(m, {1, 1, 1}), (float3{3, 4, 5}));
  EXPECT_EQ(transform_vector(m, {1, 1, 1}), (float3{2, 2, 2}));
}

TEST(Mat, InverseUndoes) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    // The matrices are well conditioned, so that the only error is rounding to float.
    const float4x4 m = noise(seed) * scaling({0.3f, 0.3f, 0.3f}) * translation({1, 2, 3});
    float4x4 strong = m;
    for (std::size_t c = 0; c < 4; ++c) strong.column[c] = strong.column[c] + float4x4().column[c] * 3.0f;
    expect_near(inverse(strong) * strong, {}, 1e-5f);
    expect_near(strong * inverse(strong), {}, 1e-5f);
  }
  EXPECT_EQ(inverse(scaling({2, 4, 8})), scaling({0.5f, 0.25f, 0.125f}));
  EXPECT_EQ(inverse(translation({1, 2, 3})), translation({-1, -2, -3}));
  EXPECT_EQ(inverse(scaling({1, 0, 1})), float4x4());
  // A zero on the diagonal requires a pivot from another row.
  const float4x4 swap = {{float4{0, 1, 0, 0}, float4{1, 0, 0, 0}, float4{0, 0, 1, 0}, float4{0, 0, 0, 1}}};
  EXPECT_EQ(inverse(swap), swap);
}

TEST(Mat, DeterminantIsTheVolume) {
  EXPECT_EQ(determinant3(scaling({2, 3, 5})), 30);
  EXPECT_EQ(determinant3(scaling({-2, 3, 5})), -30);
  EXPECT_EQ(determinant3(translation({7, 8, 9})), 1);
  EXPECT_NEAR(determinant3(rotation({1, 2, 3}, 0.7f)), 1, 1e-6f);
}

TEST(Mat, NormalsStayPerpendicularAndInFront) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const float4x4 m = noise(seed);
    const float3 a = {0.3f, -0.7f, 0.2f}, b = {0.5f, 0.1f, -0.9f};
    const float3 normal = cross(a, b);
    const float3 ma = transform_vector(m, a), mb = transform_vector(m, b);
    const float3 moved = transform_vector(normal_matrix(m), normal);
    EXPECT_NEAR(dot(moved, ma), 0, 1e-6f);
    EXPECT_NEAR(dot(moved, mb), 0, 1e-6f);
    // The side of the surface is preserved, also under mirroring.
    const float side = dot(moved, transform_vector(m, normal));
    EXPECT_GE(side * std::abs(determinant3(m)), 0);
  }
  // A flattened object still has normals.
  EXPECT_EQ(transform_vector(normal_matrix(scaling({1, 0, 1})), {0, 1, 0}), (float3{0, 1, 0}));
}

}  // namespace
}  // namespace zoneplate
