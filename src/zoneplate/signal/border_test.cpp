// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/border.h"

#include <gtest/gtest.h>

#include <string>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

std::string shown(Border border, int n) {
  std::string out;
  for (int i = -2 * n; i < 3 * n; ++i) {
    const int at = border_index(i, n, border);
    out += at < 0 ? '0' : static_cast<char>('a' + at);
  }
  return out;
}

TEST(Border, RulesAreAsTheirPicturesShow) {
  EXPECT_EQ(shown(Border::Clamp, 4), "aaaaaaaaabcddddddddd");
  EXPECT_EQ(shown(Border::Reflect, 4), "abcddcbaabcddcbaabcd");
  EXPECT_EQ(shown(Border::Wrap, 4), "abcdabcdabcdabcdabcd");
  EXPECT_EQ(shown(Border::Zero, 4), "00000000abcd00000000");
  EXPECT_EQ(shown(Border::Cut, 4), "00000000abcd00000000");
  for (Border border : {Border::Clamp, Border::Reflect, Border::Wrap}) EXPECT_EQ(border_index(-9, 1, border), 0);
  EXPECT_EQ(border_index(-2147483647, 3, Border::Reflect), border_index(-2147483647 % 6, 3, Border::Reflect));
}

TEST(Border, NamesReadBack) {
  for (Border border : {Border::Clamp, Border::Reflect, Border::Wrap, Border::Zero, Border::Cut})
    EXPECT_EQ(parse_border(name_of(border)), border);
  EXPECT_THROW(parse_border("mirror"), Error);
}

TEST(Border, PaddingWritesTheBorderOutAndCroppingTakesItAway) {
  Plane<float> plane(3, 2);
  for (float i = 1; float& v : plane.values()) v = i++;
  for (Border border : {Border::Clamp, Border::Reflect, Border::Wrap, Border::Zero}) {
    const Plane<float> wide = padded(plane, {.left = 5, .top = 1, .right = 2, .bottom = 4}, border);
    ASSERT_EQ(wide.width(), 10);
    ASSERT_EQ(wide.height(), 7);
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 10; ++x) {
        const int from_x = border_index(x - 5, 3, border), from_y = border_index(y - 1, 2, border);
        EXPECT_EQ(wide(x, y), from_x < 0 || from_y < 0 ? 0.0f : plane(from_x, from_y));
      }
    EXPECT_EQ(cropped(wide, 5, 1, 3, 2), plane);
  }
  EXPECT_TRUE(padded(Plane<float>(), {1, 1, 1, 1}, Border::Clamp).empty());
  EXPECT_EQ(padded(Plane<Linear>(1, 1), {1, 0, 0, 0}, Border::Zero)(0, 0).a, 0.0f);
}

}  // namespace
}  // namespace zoneplate
