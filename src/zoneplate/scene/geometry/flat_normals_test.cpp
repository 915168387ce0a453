// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/flat_normals.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

TEST(FlatNormal, IsAUnitOnTheSideOfCounterClockwiseCornersAtAnySize) {
  for (const float size : {1e-40f, 1e-20f, 1.0f, 1e20f, 1e38f}) {
    EXPECT_EQ(flat_normal({0, 0, 0}, {size, 0, 0}, {0, size, 0}), (float3{0, 0, 1})) << size;
    EXPECT_EQ(flat_normal({0, 0, 0}, {0, size, 0}, {size, 0, 0}), (float3{0, 0, -1})) << size;
  }
}

TEST(FlatNormal, IsUpWhereThereIsNone) {
  EXPECT_EQ(flat_normal({1, 1, 1}, {2, 2, 2}, {3, 3, 3}), (float3{0, 1, 0}));
  EXPECT_EQ(flat_normal({0, 0, 0}, {std::numeric_limits<float>::infinity(), 0, 0}, {0, 1, 0}), (float3{0, 1, 0}));
}

TEST(FlatNormals, EveryTriangleGetsItsOwn) {
  Mesh m;
  m.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  m.uv0 = {{0, 0}, {1, 0}, {2, 0}, {3, 0}};
  m.index = {0, 1, 2, 0, 3, 1};
  make_flat_normals(m);
  EXPECT_EQ(m.index, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(m.normal, (std::vector<float3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(m.uv0[4], (float2{3, 0}));
  EXPECT_EQ(m.position[5], (float3{1, 0, 0}));
}

TEST(FlatNormals, TwinsGiveTheSameBitsAndTouchNothingElse) {
  for (const std::size_t triangles : {0u, 1u, 3u, 4u, 5u, 8u, 9u, 67u})
    for (const std::size_t stride : {36u, 50u}) {
      // Corners up to the last byte of their memory; some triangles have no area, some are huge or tiny.
      std::vector<std::uint8_t> corners(triangles == 0 ? 0 : (triangles - 1) * stride + 36);
      for (std::size_t i = 0; i < triangles; ++i) {
        float values[9];
        for (std::uint32_t k = 0; k < 9; ++k)
          values[k] = (unit_float(hash(static_cast<std::uint32_t>(i), k)) - 0.5f) * (i % 5 == 1   ? 1e30f
                                                                                     : i % 5 == 2 ? 1e-30f
                                                                                     : i % 5 == 3 ? 0.0f
                                                                                                  : 1.0f);
        std::memcpy(&corners[i * stride], values, sizeof values);
      }
      std::vector<float> expected(9 * triangles + 1, 7.0f);
      FlatNormalKernels::of(Isa::Scalar).make(corners.data(), stride, triangles, expected.data());
      EXPECT_EQ(expected.back(), 7);
      for (const Isa isa : supported_isas()) {
        std::vector<float> found(9 * triangles + 1, 7.0f);
        FlatNormalKernels::of(isa).make(corners.data(), stride, triangles, found.data());
        EXPECT_EQ(found, expected) << name_of(isa) << " " << triangles;
      }
    }
}

}  // namespace
}  // namespace zoneplate
