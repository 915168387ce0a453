#include "zoneplate/image/dither.h"

#include <gtest/gtest.h>

#include "zoneplate/image/pfm.h"

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

TEST(Pfm, RowsRunFromTheBottomUp) {
  LinearImage image(1, 2);
  image(0, 0) = {1, 2, 3, 1};
  image(0, 1) = {0.5f, 0, 0, 1};
  const std::vector<std::uint8_t> bytes = encode_pfm(image);
  const std::string head = "PF\n1 2\n-1.0\n";
  ASSERT_EQ(bytes.size(), head.size() + 24);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 12), head);
  EXPECT_EQ(bytes[head.size() + 3], 0x3f);   // 0.5f ends in 3f
  EXPECT_EQ(bytes[head.size() + 23], 0x40);  // 3.0f in 40
}

}  // namespace
}  // namespace zoneplate
