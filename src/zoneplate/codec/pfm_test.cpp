#include "zoneplate/codec/pfm.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

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
