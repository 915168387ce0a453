// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/bin.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/raster/tile/rasterize.h"

namespace zoneplate {
namespace {

TEST(Arena, ListsKeepTheirOrderAndArraysTheirPlace) {
  Arena arena;
  for (int turn = 0; turn < 2; ++turn) {
    ArenaList<std::uint32_t> lists[3];
    ArenaArray<double> array;
    EXPECT_TRUE(lists[0].empty());
    EXPECT_FALSE(lists[0].begin() != lists[0].end());
    std::vector<std::size_t> numbers;
    std::vector<const double*> places;
    for (std::uint32_t i = 0; i < 5000; ++i) {
      lists[i % 3].push_back(i, arena);
      double* element = array.reserve(1 + i % 7, arena);
      *element = i;
      numbers.push_back(array.add(1));
      places.push_back(element);
    }
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::uint32_t expected = k;
      for (const std::uint32_t v : lists[k]) {
        EXPECT_EQ(v, expected);
        expected += 3;
      }
      EXPECT_GE(expected, 5000u);
    }
    EXPECT_EQ(array.size(), 5000u);
    for (std::uint32_t i = 0; i < 5000; ++i) {
      EXPECT_EQ(&array[numbers[i]], places[i]);
      EXPECT_EQ(array[numbers[i]], i);
    }
    arena.clear();
  }
}

TEST(Arena, MemoryIsOnACacheLineAndKept) {
  Arena arena;
  std::vector<std::byte*> first;
  for (std::size_t i = 0; i < 60; ++i) first.push_back(arena.take(Arena::largest - 100 * i));
  arena.clear();
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(first[i]) % 64, 0u);
    EXPECT_EQ(arena.take(Arena::largest - 100 * i), first[i]);
  }
  RawMemory memory;
  std::byte* large = memory.reserve(std::size_t{5} << 20);
  EXPECT_EQ(memory.reserve(1000), large);
  RawMemory moved = std::move(memory);
  EXPECT_EQ(moved.reserve(1000), large);
  EXPECT_NE(memory.reserve(1000), large);  // NOLINT: what was moved from is empty
}

/// Every surface in the colour of its instance, half transparent where it may be.
class Plain : public FragmentShader {
 public:
  void shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const override {
    for (int i = 0; i < batch.count; ++i) {
      const std::size_t leader = batch.leader(static_cast<std::size_t>(i));
      const float v = unit_float(hash(batch.triangle[leader], batch.instance[leader]));
      out.r[i] = v, out.g[i] = 0.5f * v, out.b[i] = 0.25f, out.a[i] = 0.5f;
    }
  }
  float alpha(const FragmentBatch& batch, float* out) const override {
    for (int i = 0; i < batch.count; ++i)
      out[i] = unit_float(hash(batch.triangle[batch.leader(static_cast<std::size_t>(i))]));
    return 0.5f;
  }
};

TEST(Bins, SharedMemoryLeavesNoTrace) {
  // Frames of several sizes, patterns and numbers of triangles, each in fresh memory and in what the others left.
  std::vector<float4> clip;
  std::vector<std::uint32_t> index;
  for (std::uint32_t t = 0; t < 6000; ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto at = [&](std::uint32_t axis) { return unit_float(hash(t, axis)) * 2 - 1; };
      const float size = t % 20 ? 0.01f : 0.4f;
      clip.push_back({at(0) + size * at(2 + 2 * k), at(1) + size * at(3 + 2 * k), 0.5f + 0.4f * at(8), 1});
      index.push_back(static_cast<std::uint32_t>(index.size()));
    }
  RasterMemory memory;
  for (const int threads : {1, 3, 2})
    with_threads(threads, [&] {
      for (const std::size_t triangles : {2000u, 30u, 0u, 700u})
        for (const int size : {200, 70}) {
          std::vector<Draw> draws(3);
          for (std::size_t d = 0; d < 3; ++d) {
            draws[d].clip = clip;
            draws[d].index = std::span(index).subspan(3 * d * triangles, 3 * triangles);
            draws[d].alpha_mode = static_cast<AlphaMode>(d);
            draws[d].instance = static_cast<std::uint32_t>(d);
          }
          LinearImage expected(size, size, Linear{0, 0, 0, 0}), found = expected;
          Target target;
          target.viewport = {size, size};
          target.width = target.height = size;
          target.samples = standard_pattern(threads == 2 ? 8 : 1);
          target.color = &expected;
          const RasterCounts once = rasterize(draws, Plain(), {}, target);
          target.color = &found;
          const RasterCounts again = rasterize(draws, Plain(), {}, target, &memory);
          EXPECT_EQ(found, expected) << triangles << " triangles, " << size << " pixels";
          EXPECT_EQ(again.set_up, once.set_up);
          EXPECT_EQ(again.shaded, once.shaded);
        }
    });
}

}  // namespace
}  // namespace zoneplate
