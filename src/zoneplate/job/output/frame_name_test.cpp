// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/output/frame_name.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

std::string named(const std::string& name, int frame) {
  const std::optional<FramePlace> place = find_frame_place(name);
  return place ? frame_name(name, *place, frame) : "none";
}

TEST(FrameName, NumbersStandWhereTheNameSaysAndAsWideAsItSays) {
  EXPECT_EQ(named("a.####.png", 7), "a.0007.png");
  EXPECT_EQ(named("a.#.png", 123), "a.123.png");
  EXPECT_EQ(named("a%03d.png", 7), "a007.png");
  EXPECT_EQ(named("a%d.png", 7), "a7.png");
  EXPECT_EQ(named("a_{frame:05}.png", 42), "a_00042.png");
  EXPECT_EQ(named("a_{frame}.png", -3), "a_-3.png");
  EXPECT_EQ(named("a.@@@.png", 7), "a.007.png");
  EXPECT_EQ(named("a.$F4.png", 7), "a.0007.png");
  EXPECT_EQ(named("a.$F.png", 7), "a.7.png");
  EXPECT_EQ(named("####left_%03dx.png", 7), "0007left_%03dx.png");
  EXPECT_EQ(named("icon@2x_##.png", 7), "icon@2x_07.png");
  EXPECT_EQ(named("5%done_%d.png", 7), "5%done_7.png");
}

TEST(FrameName, OtherNamesHaveNoNumber) {
  for (const char* name : {"a.png", "100%.png", "a{frame", "{frame:x}.png", "%5x.png", "chair@2x.png", "me@home.png",
                           "100%done.png", "no#1.png", "c#sharp.png", "cost$Final.png", "a.####2.png", "{frame}1.png"})
    EXPECT_FALSE(find_frame_place(name)) << name;
  for (const char* name : {"#", "@@", "$F", "$F4", "%04d", "{frame}", "{frame:4}", "a#.png", "a@_b.png", "%d_x.png"})
    EXPECT_TRUE(find_frame_place(name)) << name;
}

TEST(FrameName, NumbersAreReadAsTheyAreWritten) {
  for (const char* name : {"#", "####", "{frame:02}"})
    for (const int frame : {-1234, -7, 0, 7, 42, 1234, 123456})
      EXPECT_EQ(frame_of(named(name, frame), find_frame_place(name)->digits), frame) << name;
  for (const char* text : {"", "-", "7", "07", "00042", "-0000", "4x42", "+0042"})
    EXPECT_FALSE(frame_of(text, 4)) << text;
}

}  // namespace
}  // namespace zoneplate
