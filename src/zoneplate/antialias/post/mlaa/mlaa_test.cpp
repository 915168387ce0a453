// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/mlaa/mlaa.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/post/mlaa/edge_detection.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

using Kind = MlaaOptions::Kind;

TEST(Mlaa, OutputsHaveTheirBits) {
  const Rgba8Image image = random_shapes(200, 150, 1);
  const auto hash = [&](const MlaaOptions& o) { return hash_of(apply_mlaa(image, o)); };
  EXPECT_EQ(hash({.kind = Kind::Jimenez}), 0x337420ebaf291ca9u);
  EXPECT_EQ(hash({.steps = 4, .mixes_light = false}), 0xd3f9bbbce922e22u);
  EXPECT_EQ(hash({.kind = Kind::Reshetov}), 0xc027e75bd9b0a194u);
}

TEST(Mlaa, InstructionSetsAndThreadsLeaveNoTrace) {
  const Rgba8Image image = random_shapes(203, 77, 2);
  for (const Kind kind : {Kind::Jimenez, Kind::Reshetov}) {
    const Rgba8Image expected = with_isa(Isa::Scalar, [&] { return apply_mlaa(image, {.kind = kind}); });
    for (const Isa isa : supported_isas())
      for (const int threads : {1, 2, 7})
        with_isa(isa, [&] {
          with_threads(threads,
                       [&] { EXPECT_EQ(apply_mlaa(image, {.kind = kind}), expected) << name_of(isa) << threads; });
        });
  }
}

TEST(Mlaa, KernelsFindTheEdgesOfTheirTwins) {
  std::vector<std::uint8_t> codes(2 * 4 * 210);
  for (std::uint32_t i = 0; i < codes.size(); ++i)
    codes[i] = static_cast<std::uint8_t>(100 + hash(i) % (i % 5 == 0 ? 40 : 17));
  const std::uint8_t *above = &codes[0], *here = &codes[840];
  std::vector<float> luma(4 * 210);
  for (std::uint32_t i = 0; i < luma.size(); ++i) luma[i] = static_cast<float>(hash(i, 1) % 64);
  const EdgeRows<float> rows{{&luma[2], &luma[212], &luma[422], &luma[632]}};
  for (const Isa isa : supported_isas())
    for (std::size_t n = 0; n <= 200; ++n) {
      std::vector<std::uint8_t> expected(n + 1, 9), found = expected;
      MlaaKernels::scalar.edges_row(above, here, 16, expected.data(), n);
      MlaaKernels::of(isa).edges_row(above, here, 16, found.data(), n);
      ASSERT_EQ(found, expected) << name_of(isa);
      std::vector<std::uint8_t> lines(n + 1, 9), others = lines;
      MlaaKernels::scalar.luma_edges(rows, 25, lines.data(), n);
      MlaaKernels::of(isa).luma_edges(rows, 25, others.data(), n);
      ASSERT_EQ(others, lines) << name_of(isa);
      if (n < 200) continue;
      for (const int edges : {0, 1, 2, 3}) EXPECT_GT(std::ranges::count(lines, edges), 5);
      for (const int edges : {0, 1, 2, 3}) EXPECT_GT(std::ranges::count(found, edges), 10);
    }
}

TEST(Mlaa, LinesAreFoundWhereverTheyBeginAndEnd) {
  // Bars of all lengths at all columns and rows: the blending at a bar's end does not depend on its position.
  const auto bar = [](int begin, int end, bool is_level) {
    return make_codes(90, 90, [=](int x, int y) {
      const int along = is_level ? x : y, across = is_level ? y : x;
      return across == 40 && along >= begin && along < end ? Rgba8{220, 220, 220} : Rgba8{20, 20, 20};
    });
  };
  for (const bool is_level : {true, false})
    for (int begin = 1; begin < 75; begin += 9)
      for (const int length : {1, 7, 8, 14}) {
        const MlaaOptions options{.kind = Kind::Reshetov};
        const Rgba8Image out = apply_mlaa(bar(begin, begin + length, is_level), options);
        const Rgba8Image first = apply_mlaa(bar(1, 1 + length, is_level), options);
        for (int i = -1; i <= length; ++i)
          for (int j = 38; j < 43; ++j) {
            const auto at = [&](const Rgba8Image& image, int along) {
              return is_level ? image(along, j) : image(j, along);
            };
            ASSERT_EQ(at(out, begin + i), at(first, 1 + i)) << begin << " " << length << " " << is_level;
          }
      }
}

TEST(Mlaa, StepsOfOneLengthBecomeTheirLine) {
  // Every step of a slope 1 / n is a Z shape, and the line through the middles of its ends is the edge itself.
  for (const Kind kind : {Kind::Jimenez, Kind::Reshetov})
    for (int n = 3; n < 24; ++n) {
      const Rgba8Image stairs = make_codes(200, 90, [&](int x, int y) {
        return y < 14 + x / n ? Rgba8{200, 200, 200} : Rgba8{50, 50, 50};
      });
      const Rgba8Image out = apply_mlaa(stairs, {.kind = kind, .mixes_light = false});
      for (int x = 2 * n; x < 200 - 2 * n; ++x) {
        if (x % n == 0 || x % n == n - 1) continue;  // the steps themselves are lines of one pixel
        for (int y = 0; y < 90; ++y) {
          const double middle = 13.5 + (x + 0.5) / n;  // the position of the edge in this column
          const double area = std::clamp(middle - y, 0.0, 1.0);
          // A line that leaves the pixel's row inside the column is clipped there: an error of at most 1 / (8 n).
          ASSERT_NEAR(out(x, y).g, 50 + 150 * area, 1.5 + 150 / (8.0 * n)) << n << ": " << x << "," << y;
        }
      }
    }
}

TEST(Mlaa, InvertedPicturesGiveInvertedResults) {
  const auto inverted = [](Rgba8Image image) {
    for (Rgba8& c : image.values()) c = {std::uint8_t(255 - c.r), std::uint8_t(255 - c.g), std::uint8_t(255 - c.b)};
    return image;
  };
  const Rgba8Image image = random_shapes(120, 90, 9);
  for (const Kind kind : {Kind::Jimenez, Kind::Reshetov}) {
    const MlaaOptions options{.kind = kind, .mixes_light = false};
    // The results only differ by the rounding of halves, which is always upwards.
    EXPECT_EQ(count_differing(apply_mlaa(inverted(image), options), inverted(apply_mlaa(image, options)), 1), 0);
  }
}

TEST(Mlaa, LinesSplitWhereColoursMeet) {
  EXPECT_EQ(split_height(0, 9, 9, 0), 0.5f);  // black and white: every height is a solution
  // (1 - h) near + h across = h beyond + (1 - h) beyond_near
  for (const auto& [near, across, beyond, beyond_near] :
       {std::array{10, 90, 60, 30}, {0, 50, 20, 5}, {7, 200, 3, 150}}) {
    const double h = static_cast<double>(split_height(near, across, beyond, beyond_near));
    ASSERT_GE(h, 0);
    ASSERT_LE(h, 1);
    EXPECT_NEAR((1 - h) * near + h * across, h * beyond + (1 - h) * beyond_near, 1e-4);
  }
  EXPECT_EQ(split_height(10, 20, 90, 30), 0.5f);  // no height is a solution
}

TEST(Mlaa, WhatIsTooFaintIsNoEdge) {
  const auto step = [](std::uint8_t low, std::uint8_t high) {
    return make_codes(60, 30, [=](int x, int y) {
      return y < 10 + x / 6 ? Rgba8{high, high, high} : Rgba8{low, low, low};
    });
  };
  EXPECT_EQ(apply_mlaa(step(100, 125), {}), step(100, 125));
  EXPECT_NE(apply_mlaa(step(100, 126), {}), step(100, 126));
  EXPECT_EQ(apply_mlaa(step(100, 115), {.kind = Kind::Reshetov}), step(100, 115));
  EXPECT_NE(apply_mlaa(step(100, 116), {.kind = Kind::Reshetov}), step(100, 116));
}

}  // namespace
}  // namespace zoneplate::antialias
