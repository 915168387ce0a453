// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace zoneplate {
namespace {

constexpr float half_pi = 1.57079632679f;

void expect_near(float3 found, float3 expected, float tolerance = 1e-6f) {
  EXPECT_LE(length(found - expected), tolerance) << found.x << ' ' << found.y << ' ' << found.z;
}

float3 projected(const float4x4& m, float3 p) {
  const float4 c = m * float4{p.x, p.y, p.z, 1};
  return {c.x / c.w, c.y / c.w, c.z / c.w};
}

TEST(Transform, RotatesCounterClockwise) {
  expect_near(transform_vector(rotation({0, 0, 1}, half_pi), {1, 0, 0}), {0, 1, 0});
  expect_near(transform_vector(rotation({0, 2, 0}, half_pi), {0, 0, 1}), {1, 0, 0});
  expect_near(transform_vector(rotation({1, 0, 0}, half_pi), {0, 1, 0}), {0, 0, 1});
  expect_near(transform_vector(rotation({1, 1, 1}, 2 * half_pi * 2 / 3), {1, 2, 3}), {3, 1, 2});
}

TEST(Transform, QuaternionsAreNormalised) {
  const float s = std::sqrt(0.5f);
  EXPECT_EQ(rotation(Quaternion{0, 0, 0, 0}), float4x4());
  EXPECT_EQ(rotation(Quaternion{0, 0, 0, 5}), float4x4());
  expect_near(transform_vector(rotation(Quaternion{0, 0, 3 * s, 3 * s}), {1, 0, 0}), {0, 1, 0});
}

TEST(Transform, LookAtLooksAlongMinusZ) {
  const float3 eye = {1, 2, 3}, target = {4, 6, 3};
  const float4x4 view = look_at(eye, target, {0, 0, 1});
  expect_near(transform_point(view, eye), {0, 0, 0});
  expect_near(transform_point(view, target), {0, 0, -5}, 2e-6f);
  expect_near(transform_vector(view, {0, 0, 1}), {0, 1, 0});
  EXPECT_NEAR(determinant3(view), 1, 1e-6f);
}

TEST(Transform, LookAtAlwaysExists) {
  for (const float3 up : {float3{0, 1, 0}, float3{0, 0, 1}, float3{0, 0, 0}, float3{1, 0, 0}}) {
    for (const float3 target : {float3{0, 1, 0}, float3{0, -1, 0}, float3{0, 0, 1}, float3{1, 0, 0}, float3{0, 0, 0}}) {
      const float4x4 view = look_at({0, 0, 0}, target, up);
      EXPECT_NEAR(determinant3(view), 1, 1e-5f);
      if (dot(target, target) > 0) expect_near(transform_point(view, target), {0, 0, -1});
    }
  }
}

TEST(Transform, PerspectiveReversesDepth) {
  const float4x4 m = perspective(half_pi, 2, 0.5f, 100);
  EXPECT_NEAR(projected(m, {0, 0, -0.5f}).z, 1, 1e-6f);
  EXPECT_NEAR(projected(m, {0, 0, -100}).z, 0, 1e-6f);
  expect_near(projected(m, {20, 10, -10}), {1, 1, projected(m, {0, 0, -10}).z});
  EXPECT_GT(projected(m, {0, 0, -1}).z, projected(m, {0, 0, -2}).z);
  EXPECT_EQ((m * float4{1, 2, -7, 1}).w, 7);

  const float4x4 endless = perspective(half_pi, 2, 0.5f, std::numeric_limits<float>::infinity());
  EXPECT_EQ(projected(endless, {0, 0, -0.5f}).z, 1);
  EXPECT_EQ(projected(endless, {0, 0, -5}).z, 0.1f);
  EXPECT_GT(projected(endless, {0, 0, -1e30f}).z, 0);
}

TEST(Transform, OrthographicReversesDepth) {
  const float4x4 m = orthographic(4, 2, 1, 9);
  expect_near(projected(m, {4, -2, -1}), {1, -1, 1});
  expect_near(projected(m, {0, 1, -9}), {0, 0.5f, 0});
  expect_near(projected(m, {-2, 0, -5}), {-0.5f, 0, 0.5f});
}

}  // namespace
}  // namespace zoneplate
