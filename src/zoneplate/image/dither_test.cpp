// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/dither.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

TEST(Dither, TheMeanIsTheValueAndExactCodesHaveNoNoise) {
  const DisplayImage image(200, 200, {100.25f / 255, 0, 1, 0.5f});
  const Rgba8Image out = quantize8_dithered(image);
  double sum = 0;
  for (const Rgba8 p : out.values()) {
    EXPECT_TRUE(p.r == 100 || p.r == 101);
    EXPECT_EQ(p.g, 0);
    EXPECT_EQ(p.b, 255);
    EXPECT_EQ(p.a, 128);
    sum += p.r;
  }
  // 40,000 draws of variance 3/16: five standard deviations are 0.011.
  EXPECT_NEAR(sum / 40000, 100.25, 0.011);
}

}  // namespace
}  // namespace zoneplate
