#include "zoneplate/antialias/dlaa.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/charts_for_test.h"

namespace zoneplate::antialias {
namespace {

TEST(Dlaa, OutputsHaveTheirBits) {
  const auto hash = [&](std::uint32_t seed) { return hash_of(apply_dlaa(random_shapes(200, 150, seed))); };
  EXPECT_EQ(hash(1), 0xda3957b5a4da20efu);
  EXPECT_EQ(hash(2), 0x9205e26c7a10ab08u);
}

TEST(Dlaa, AShortEdgeIsBlurredAlongItself) {
  // A grey level border of the lightest contrast that is treated, and one just below it.
  const auto border = [](std::uint8_t dark, std::uint8_t light) {
    return make_codes(40, 30, [=](int, int y) {
      return y < 15 ? Rgba8{dark, dark, dark} : Rgba8{light, light, light};
    });
  };
  // Along a level border there is nothing to mix.
  EXPECT_EQ(apply_dlaa(border(0, 255)), border(0, 255));
  // One step in it is mixed over two pixels to either side, and the contrast above it counts: |T + B - 2 C| / 2.
  const auto stepped = [](std::uint8_t dark, std::uint8_t light) {
    return make_codes(40, 30, [=](int x, int y) {
      return y < (x < 20 ? 15 : 16) ? Rgba8{dark, dark, dark} : Rgba8{light, light, light};
    });
  };
  EXPECT_EQ(apply_dlaa(stepped(100, 108)), stepped(100, 108));
  EXPECT_NE(apply_dlaa(stepped(100, 140)), stepped(100, 140));
}

TEST(Dlaa, LongEdgesBecomeRamps) {
  // A step of one pixel in a border of full contrast: the long blur of 16 pixels makes a ramp of 16 steps of it.
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
