// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/cmaa2/cmaa2.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/post/cmaa2/edge_detection.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

TEST(Cmaa2, OutputsHaveTheirBits) {
  const Rgba8Image image = random_shapes(200, 150, 1);
  const auto hash = [&](const Cmaa2Options& o) { return hash_of(apply_cmaa2(image, o)); };
  EXPECT_EQ(hash({.threshold = 0.07f}), 0xe8b1b47cdba6b136u);
  EXPECT_EQ(hash({.threshold = 0.05f, .is_sharp = true}), 0x37a44c760bf598a1u);
  EXPECT_EQ(hash({.threshold = 0.15f}), 0x360702e601e98f52u);
}

TEST(Cmaa2, InstructionSetsAndThreadsLeaveNoTrace) {
  const Rgba8Image image = random_shapes(203, 77, 2);
  const Rgba8Image expected = with_isa(Isa::Scalar, [&] { return apply_cmaa2(image, {}); });
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 2, 7})
      with_isa(isa, [&] {
        with_threads(threads, [&] { EXPECT_EQ(apply_cmaa2(image, {}), expected) << name_of(isa) << threads; });
      });
}

TEST(Cmaa2, KernelsFindWhatTheirTwinsFind) {
  std::vector<float> luma(4 * 300);
  for (std::uint32_t i = 0; float& v : luma) v = unit_float(hash(i++));
  const float* const rows[4] = {&luma[1], &luma[301], &luma[601], nullptr};
  std::vector<std::uint8_t> edges(300), above(300);
  for (std::uint32_t i = 0; i < 300; ++i) edges[i] = hash(i) & 3, above[i] = hash(i + 1000) & 3;
  for (const Isa isa : supported_isas()) {
    const Cmaa2Kernels& kernels = Cmaa2Kernels::of(isa);
    for (std::size_t n = 0; n <= 200; ++n) {
      std::vector<std::uint8_t> expected(n + 1, 9), found(n + 1, 9);
      Cmaa2Kernels::scalar.edge_row(rows, 0.07f, 0.1f, expected.data(), n);
      kernels.edge_row(rows, 0.07f, 0.1f, found.data(), n);
      ASSERT_EQ(found, expected);
      std::vector<std::uint8_t> shapes(n + 64), bits(64), shapes2(n + 64), bits2(64);
      Cmaa2Kernels::scalar.shape_row(&edges[1], &above[1], shapes.data(), bits.data(), n);
      kernels.shape_row(&edges[1], &above[1], shapes2.data(), bits2.data(), n);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_EQ(shapes[i], shapes2[i]);
        ASSERT_EQ(bits[i / 8] >> i % 8 & 1, bits2[i / 8] >> i % 8 & 1);
      }
    }
  }
}

TEST(Cmaa2, WithoutCornersNothingChanges) {
  const Rgba8Image stripes = make_codes(90, 60, [](int x, int) {
    return x / 3 % 2 == 0 ? Rgba8{250, 250, 250} : Rgba8{10, 40, 10};
  });
  EXPECT_EQ(apply_cmaa2(stripes, {.threshold = 0.05f}), stripes);
  const Rgba8Image lines = make_codes(90, 60, [](int, int y) {
    return y % 7 == 0 ? Rgba8{0, 0, 0} : Rgba8{200, 90, 9};
  });
  EXPECT_EQ(apply_cmaa2(lines, {.threshold = 0.05f}), lines);
}

TEST(Cmaa2, ALongStepBecomesARampOfLight) {
  // One step in the middle of a border of 200 pixels: both lines have the maximum length of the search, and light
  // decreases linearly from one half at the step.
  const Rgba8Image step = make_codes(200, 40, [](int x, int y) {
    return y < (x < 100 ? 20 : 21) ? Rgba8{255, 255, 255} : Rgba8{0, 0, 0};
  });
  const Rgba8Image out = apply_cmaa2(step, {});
  const auto light = [&](int x, int y) { return static_cast<double>(decode_srgb8(out(x, y).g)); };
  // 43 pixels on each side; those at the step are also blurred.
  for (int i = 1; i < 43; ++i) {
    EXPECT_NEAR(light(99 - i, 20), 0.5 * (42.5 - i) / 43, 0.012) << i;
    EXPECT_NEAR(light(100 + i, 20), 1 - 0.5 * (42.5 - i) / 43, 0.012) << i;
  }
  EXPECT_EQ(out(50, 20), step(50, 20));
  EXPECT_EQ(out(150, 20), step(150, 20));
}

TEST(Cmaa2, MeanLightIsKeptAndLevelEdgesComeNearTheirArea) {
  for (const double run : {5.0, 8.0, 13.0, 20.0}) {
    const Band plane{run, 1000};
    const Rgba8Image before = plane.codes(0.5, 0.5), after = apply_cmaa2(before, {});
    EXPECT_LT(plane.error(after), 0.35 * plane.error(before)) << run;
    double sum = 0;
    for (std::size_t i = 0; i < after.values().size(); ++i)
      sum += static_cast<double>(decode_srgb8(after.values()[i].g) - decode_srgb8(before.values()[i].g));
    EXPECT_LT(std::abs(sum) / static_cast<double>(after.values().size()), 0.002) << run;
  }
}

TEST(Cmaa2, AQuarterTurnTurnsTheResult) {
  const Rgba8Image image = random_shapes(120, 120, 11);
  const auto turned = [](const Rgba8Image& from) {
    return make_codes(120, 120, [&](int x, int y) { return from(y, 119 - x); });
  };
  // Of equally good horizontal and vertical steps the horizontal one is used.
  EXPECT_LE(count_differing(apply_cmaa2(turned(image), {}), turned(apply_cmaa2(image, {})), 0), 120 * 120 / 1000);
}

}  // namespace
}  // namespace zoneplate::antialias
