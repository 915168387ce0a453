// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/fragment/interpolate.h"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr Viewport viewport{640, 480};

/// Rows of some triangles, four groups each, and what interpolation makes of them.
struct Rows {
  static constexpr int triangles = FragmentBatch::groups / 4;
  ScreenVertex vertex[triangles][3];
  BatchTriangles corners;
  FragmentBatch batch;

  explicit Rows(std::uint32_t key) {
    std::memset(static_cast<void*>(&corners), 0, sizeof corners);
    std::memset(static_cast<void*>(&batch), 0, sizeof batch);
    batch.count = FragmentBatch::capacity;
    for (std::uint32_t t = 0; t < triangles; ++t)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const bool is_affine = (t + key) % 2 == 0, is_small = t % 3 == 0;
        const auto number = [&](std::uint32_t what) { return hash(key, 16 * t + 4 * k + what); };
        const std::uint32_t extent = is_small ? 600 : 400000;
        vertex[t][k].x = static_cast<std::int32_t>(number(0) % extent) - static_cast<std::int32_t>(extent / 2);
        vertex[t][k].y = static_cast<std::int32_t>(number(1) % extent) - static_cast<std::int32_t>(extent / 2);
        vertex[t][k].inv_w = 0.1f + unit_float(is_affine ? hash(key, t) : number(2));
      }
    for (int g = 0; g < FragmentBatch::groups; ++g) {
      const int t = g / 4, first = g * FragmentBatch::group;
      batch.is_flat_run[g] = true;
      batch.run_begin[g] = static_cast<std::uint8_t>(4 * t);
      batch.run_end[g] = static_cast<std::uint8_t>(4 * t + 4);
      batch.x[first] = viewport.width * 128 - 900 + 128, batch.y[first] = viewport.height * 128 + 128 + 256 * (g % 4);
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < FragmentBatch::group; ++i) corners.vertex[k][first + i] = &vertex[t][k];
    }
  }
  void interpolate(const InterpolateKernels& kernels) {
    EXPECT_EQ(kernels.interpolate(corners, viewport, 1.0f, batch), 0u);
  }
};

bool same_floats(const FragmentBatch& p, const FragmentBatch& q) {
  return std::memcmp(p.b, q.b, sizeof p.b) == 0 && std::memcmp(p.dbdx, q.dbdx, sizeof p.dbdx) == 0 &&
         std::memcmp(p.dbdy, q.dbdy, sizeof p.dbdy) == 0;
}

TEST(Interpolate, RowsHaveTheBitsOfTheirPointsOnEveryInstructionSet) {
  for (std::uint32_t key = 0; key < 200; ++key) {
    auto expected = std::make_unique<Rows>(key);
    expected->interpolate(InterpolateKernels::scalar);
    for (const Isa isa : supported_isas()) {
      auto rows = std::make_unique<Rows>(key);
      rows->interpolate(InterpolateKernels::of(isa));
      ASSERT_TRUE(same_floats(rows->batch, expected->batch)) << key << ' ' << name_of(isa);
      ASSERT_EQ(std::memcmp(rows->batch.has_uniform_derivatives, expected->batch.has_uniform_derivatives,
                            sizeof(FragmentBatch::has_uniform_derivatives)),
                0);

      auto points = std::make_unique<Rows>(key);
      for (bool& one : points->batch.is_flat_run) one = false;
      std::memcpy(points->batch.x, expected->batch.x, sizeof points->batch.x);
      std::memcpy(points->batch.y, expected->batch.y, sizeof points->batch.y);
      points->interpolate(InterpolateKernels::of(isa));
      ASSERT_TRUE(same_floats(points->batch, expected->batch)) << key << ' ' << name_of(isa);
    }
  }
}

TEST(Interpolate, ClippedRowsHaveTheBitsOfTheirPointsOnEveryInstructionSet) {
  for (std::uint32_t key = 0; key < 200; ++key) {
    const auto number = [&](std::uint32_t k, std::uint32_t what) {
      return 4 * unit_float(hash(key, 4 * k + what)) - 2;
    };
    const auto corner = [&](std::uint32_t k) { return float4{number(k, 0), number(k, 1), 0, number(k, 2)}; };
    const BarycentricPlanes planes = barycentric_planes(corner(0), corner(1), corner(2), viewport);
    const auto rows = std::make_unique<Rows>(key), expected = std::make_unique<Rows>(key);
    expected->interpolate(InterpolateKernels::scalar);  // for x and y of all points
    rows->batch = expected->batch;
    InterpolateKernels::scalar.interpolate_clipped_rows(planes, viewport, 1.0f, expected->batch, 8, 40);
    for (const Isa isa : supported_isas()) {
      InterpolateKernels::of(isa).interpolate_clipped_rows(planes, viewport, 1.0f, rows->batch, 8, 40);
      ASSERT_TRUE(same_floats(rows->batch, expected->batch)) << key << ' ' << name_of(isa);

      ClippedGroup group{};
      for (int i = 0; i < FragmentBatch::group; ++i) {
        for (int k = 0; k < 3; ++k)
          group.x[k][i] = planes.x[k], group.y[k][i] = planes.y[k], group.one[k][i] = planes.one[k];
        group.px[i] = rows->batch.x[16 + i], group.py[i] = rows->batch.y[16 + i];
      }
      InterpolateKernels::of(isa).interpolate_clipped(viewport, 1.0f, group);
      for (int k = 0; k < 2; ++k)
        for (int i = 0; i < FragmentBatch::group; ++i) {
          ASSERT_EQ(group.b[k][i], expected->batch.b[k][16 + i]) << key << ' ' << name_of(isa);
          ASSERT_EQ(group.dbdx[k][i], expected->batch.dbdx[k][16 + i]);
          ASSERT_EQ(group.dbdy[k][i], expected->batch.dbdy[k][16 + i]);
        }
    }
  }
}

TEST(Interpolate, AffineTrianglesRepeatTheirSlopes) {
  Rows rows(0);
  rows.interpolate(InterpolateKernels::of());
  int repeated = 0;
  for (int g = 0; g < FragmentBatch::groups; ++g) {
    if (!rows.batch.has_uniform_derivatives[g]) continue;
    ++repeated;
    for (int i = g * FragmentBatch::group; i < (g + 1) * FragmentBatch::group; ++i)
      for (int k = 0; k < 2; ++k) {
        EXPECT_EQ(rows.batch.dbdx[k][i], rows.batch.dbdx[k][i - 1]);
        EXPECT_EQ(rows.batch.dbdy[k][i], rows.batch.dbdy[k][i - 1]);
      }
  }
  EXPECT_EQ(repeated, FragmentBatch::groups / 8 * 3);
}

}  // namespace
}  // namespace zoneplate
