// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/hex_color.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

TEST(HexColor, HasThreeFourSixOrEightDigits) {
  EXPECT_EQ(parse_hex_color("#fff"), (Rgba8{255, 255, 255, 255}));
  EXPECT_EQ(parse_hex_color("#1a28"), (Rgba8{0x11, 0xaa, 0x22, 0x88}));
  EXPECT_EQ(parse_hex_color("#FF8000"), (Rgba8{255, 128, 0, 255}));
  EXPECT_EQ(parse_hex_color("#0102037f"), (Rgba8{1, 2, 3, 127}));
}

TEST(HexColor, RefusesOtherTexts) {
  for (const char* text :
       {"", "#", "fff", "#12", "#12345", "#1234567", "#ggg", "#-1-1-1", "#+1+1+1", "#12 45 ", "#123456789"})
    EXPECT_EQ(parse_hex_color(text), std::nullopt) << text;
}

}  // namespace
}  // namespace zoneplate
