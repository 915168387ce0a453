// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/dlaa/dlaa.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/post/dlaa/blur.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

TEST(Dlaa, OutputsHaveTheirBits) {
  const auto hash = [&](std::uint32_t seed) { return hash_of(apply_dlaa(random_shapes(200, 150, seed))); };
  EXPECT_EQ(hash(1), 0xda3957b5a4da20efu);
  EXPECT_EQ(hash(2), 0x9205e26c7a10ab08u);
}

TEST(Dlaa, InstructionSetsAndThreadsLeaveNoTrace) {
  const Rgba8Image image = random_shapes(203, 77, 2);
  const Rgba8Image expected = with_isa(Isa::Scalar, [&] { return apply_dlaa(image); });
  for (const Isa isa : supported_isas())
    for (const int threads : {1, 2, 7})
      with_isa(isa, [&] {
        with_threads(threads, [&] { EXPECT_EQ(apply_dlaa(image), expected) << name_of(isa) << threads; });
      });
}

TEST(Dlaa, KernelsFindWhatTheirTwinsFind) {
  // Mostly small differences, and some of full contrast.
  const auto code = [](std::uint32_t i) {
    return static_cast<std::uint8_t>(hash(i / 40) % 4 == 0 ? hash(i) & 255 : 100 + (hash(i) & 7));
  };
  std::vector<std::uint8_t> codes(3 * 4 * 300);
  for (std::uint32_t i = 0; i < codes.size(); ++i) codes[i] = code(i);
  const std::uint8_t *above = &codes[4], *here = &codes[1204], *below = &codes[2404];
  std::vector<std::int16_t> level(256), upright(256);
  for (std::uint32_t i = 0; i < 256; ++i) {
    level[i] = static_cast<std::int16_t>(hash(i + 5000) % (i % 3 == 0 ? 4336 : 2042));
    upright[i] = static_cast<std::int16_t>(hash(i + 6000) % 2060);
  }
  for (const Isa isa : supported_isas()) {
    const DlaaKernels &kernels = DlaaKernels::of(isa), &twin = DlaaKernels::scalar;
    for (std::size_t n = 0; n <= 200; ++n) {
      std::vector<std::uint8_t> expected(n + 1, 9), found(n + 1, 9);
      twin.edge_row(above, here, below, expected.data(), n);
      kernels.edge_row(above, here, below, found.data(), n);
      ASSERT_EQ(found, expected);
      twin.seen_row(above, here, below, level.data(), upright.data(), 51, 2040, expected.data(), n);
      kernels.seen_row(above, here, below, level.data(), upright.data(), 51, 2040, found.data(), n);
      ASSERT_EQ(found, expected);
      std::vector<std::int16_t> sums(n), sums2(256);
      twin.sum_row(here, sums.data(), n);
      kernels.sum_row(here, sums2.data(), n);
      twin.slide_row(here, below, sums.data(), n);
      kernels.slide_row(here, below, sums2.data(), n);
      sums2.resize(n);
      ASSERT_EQ(sums2, sums);
      if (n == 200) {
        EXPECT_GT(std::ranges::count(found, 1), 20);
        EXPECT_GT(std::ranges::count(found, 0), 20);
      }
    }
  }
}

TEST(Dlaa, AShortEdgeIsBlurredAlongItself) {
  // A grey horizontal border of the least contrast that is filtered, and one just below it.
  const auto border = [](std::uint8_t dark, std::uint8_t light) {
    return make_codes(40, 30, [=](int, int y) {
      return y < 15 ? Rgba8{dark, dark, dark} : Rgba8{light, light, light};
    });
  };
  // Along a horizontal border without steps nothing changes.
  EXPECT_EQ(apply_dlaa(border(0, 255)), border(0, 255));
  // A step in it is blended over two pixels on either side; the contrast of the second difference |T + B - 2 C| / 2
  // counts.
  const auto stepped = [](std::uint8_t dark, std::uint8_t light) {
    return make_codes(40, 30, [=](int x, int y) {
      return y < (x < 20 ? 15 : 16) ? Rgba8{dark, dark, dark} : Rgba8{light, light, light};
    });
  };
  EXPECT_EQ(apply_dlaa(stepped(100, 108)), stepped(100, 108));
  EXPECT_NE(apply_dlaa(stepped(100, 140)), stepped(100, 140));
}

TEST(Dlaa, LongEdgesBecomeRamps) {
  // A step of one pixel in a border of full contrast: the long blur of 16 pixels turns it into a ramp of 16 steps.
  const Rgba8Image step = make_codes(80, 40, [](int x, int y) {
    return y < (x < 40 ? 20 : 21) ? Rgba8{220, 220, 220} : Rgba8{30, 30, 30};
  });
  const Rgba8Image out = apply_dlaa(step);
  for (int x = 33; x < 47; ++x) EXPECT_GE(out(x, 20).g, out(x - 1, 20).g) << x;
  EXPECT_LT(out(34, 20).g, 70);
  EXPECT_GT(out(34, 20).g, 31);
  EXPECT_GT(out(45, 20).g, 180);
  EXPECT_LT(out(45, 20).g, 219);
}

}  // namespace
}  // namespace zoneplate::antialias
