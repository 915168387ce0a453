// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/smooth_sums.h"

#include <gtest/gtest.h>

#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {
namespace {

/// Triangles of all sizes with few vertices, some without area, some beyond the range of floats.
struct Heap {
  std::vector<float3> position;
  std::vector<std::uint32_t> index;

  explicit Heap(std::uint32_t triangles) {
    for (std::uint32_t v = 0; v < 3 + triangles / 2; ++v) {
      const float size = v % 7 == 0 ? 1e-12f : v % 11 == 0 ? 1e20f : 1;
      position.push_back(float3{unit_float(hash(v, 0)), unit_float(hash(v, 1)), unit_float(hash(v, 2))} * size);
    }
    for (std::uint32_t i = 0; i < 3 * triangles; ++i)
      index.push_back(hash(i, 3) % static_cast<std::uint32_t>(position.size()));
  }
  const float* places() const { return &position[0].x; }
};

/// The normalized sums of all vertices except the first and the last, and the marks.
struct Found {
  std::vector<float> normal;
  std::vector<char> mark;
  bool operator==(const Found&) const = default;
};

Found found_by(const SmoothSumKernels& kernels, const Heap& heap) {
  const std::size_t vertices = heap.position.size(), triangles = heap.index.size() / 3;
  Found out{std::vector<float>(3 * vertices), std::vector<char>(vertices)};
  const VertexRange own{1, static_cast<std::uint32_t>(vertices) - 2};
  kernels.add(heap.places(), vertices, heap.index.data(), triangles, own, out.normal.data());
  kernels.normalize(&out.normal[3], own.size, &out.mark[1]);
  kernels.mark_turns(heap.places(), out.normal.data(), vertices, heap.index.data(), triangles, out.mark.data());
  return out;
}

TEST(SmoothSums, TwinsGiveTheSameBits) {
  for (const std::uint32_t triangles : {1u, 2u, 7u, 8u, 9u, 40u, 200u, 1001u}) {
    const Heap heap(triangles);
    const Found expected = found_by(SmoothSumKernels::of(Isa::Scalar), heap);
    for (const float n : expected.normal) ASSERT_LE(std::abs(n), 1.0001f);
    for (const Isa isa : supported_isas())
      EXPECT_EQ(found_by(SmoothSumKernels::of(isa), heap), expected) << name_of(isa) << triangles;
  }
}

TEST(SmoothSums, WhatFloatsDoNotHoldIsMarked) {
  // A single right triangle in the xy plane, in many sizes; then increasingly thin ones.
  const auto marked = [](float wide, float high) {
    Heap heap(1);
    heap.position = {{0, 0, 0}, {0, 0, 0}, {wide, 0, 0}, {0, high, 0}, {0, 0, 0}};
    heap.index = {1, 2, 3};
    const Found found = found_by(SmoothSumKernels::of(), heap);
    EXPECT_EQ(found.mark[1], found.mark[2]);
    EXPECT_NEAR(found.normal[found.mark[1] != 0 ? 4 : 5], 1, 1e-6f);
    return found.mark[1] != 0;
  };
  for (const float size : {1e-8f, 1e-3f, 1.0f, 1e3f, 1e8f}) EXPECT_FALSE(marked(size, size)) << size;
  for (const float size : {0.0f, 1e-38f, 1e-12f, 1e12f, 1e38f}) EXPECT_TRUE(marked(size, size)) << size;
  EXPECT_FALSE(marked(1, 0.01f));
  EXPECT_TRUE(marked(1, 0));
}

}  // namespace
}  // namespace zoneplate
