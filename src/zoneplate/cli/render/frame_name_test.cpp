// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/frame_name.h"

#include <gtest/gtest.h>

namespace zoneplate::cli {
namespace {

TEST(FrameName, NumbersStandWhereTheNameSaysAndAsWideAsItSays) {
  EXPECT_EQ(frame_name("a.####.png", 7), "a.0007.png");
  EXPECT_EQ(frame_name("a.#.png", 123), "a.123.png");
  EXPECT_EQ(frame_name("a%03d.png", 7), "a007.png");
  EXPECT_EQ(frame_name("a%d.png", 7), "a7.png");
  EXPECT_EQ(frame_name("a_{frame:05}.png", 42), "a_00042.png");
  EXPECT_EQ(frame_name("a_{frame}.png", -3), "a_-3.png");
  EXPECT_EQ(frame_name("a.@@@.png", 7), "a.007.png");
  EXPECT_EQ(frame_name("a.$F4.png", 7), "a.0007.png");
  EXPECT_EQ(frame_name("a.$F.png", 7), "a.7.png");
}

TEST(FrameName, OtherNamesHaveNoNumber) {
  for (const char* name : {"a.png", "100%.png", "a{frame", "{frame:x}.png", "%5x.png"})
    EXPECT_FALSE(has_frame_number(name)) << name;
  for (const char* name : {"#", "@@", "$F", "$F4", "%04d", "{frame}", "{frame:4}"})
    EXPECT_TRUE(has_frame_number(name)) << name;
}

}  // namespace
}  // namespace zoneplate::cli
