// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/typeface.h"

#include <gtest/gtest.h>

#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

constexpr Rgba8 white{255, 255, 255, 255}, black{0, 0, 0, 255};

bool is_blank(const Rgba8Image& image) {
  for (const Rgba8 c : image.values())
    if (c != white) return false;
  return true;
}

TEST(Typeface, WrapsAtSpacesWithinTheWidth) {
  const Typeface face(Typeface::Weight::Regular, 15);
  const std::string text = "The quick brown fox jumps over the lazy dog — über 0.9 Speichen × 2π.";
  for (const int width : {80, 100, 217, 400, 2000}) {
    std::string joined;
    for (const std::string& line : face.wrapped(text, width)) {
      EXPECT_LE(face.width(line), width);
      EXPECT_FALSE(line.starts_with(' '));
      joined += (joined.empty() ? "" : " ") + line;
    }
    EXPECT_EQ(joined, text);
  }
  EXPECT_EQ(face.wrapped(text, 2000).size(), 1u);
  EXPECT_EQ(face.wrapped("a\n\nb", 100), (std::vector<std::string>{"a", "", "b"}));
  EXPECT_TRUE(face.wrapped("", 100).empty());
}

TEST(Typeface, PartsAWordThatIsTooLong) {
  const Typeface face(Typeface::Weight::Regular, 15);
  const std::string word = "Überabtastungüberabtastungüberabtastung";
  std::string joined;
  for (const std::string& line : face.wrapped(word, 50)) {
    EXPECT_LE(face.width(line), 50);
    joined += line;
  }
  EXPECT_EQ(joined, word);
  EXPECT_EQ(face.wrapped("ab", 1), (std::vector<std::string>{"a", "b"}));
}

TEST(Typeface, PartsANameAtAJoint) {
  const Typeface face(Typeface::Weight::Regular, 15);
  const auto parted = [&](const std::string& name, const std::string& room) {
    return face.wrapped(name, static_cast<int>(face.width(room)) + 1);
  };
  EXPECT_EQ(parted("two-squares.obj", "two-squares.ob"), (std::vector<std::string>{"two-squares", ".obj"}));
  EXPECT_EQ(parted("two-squares.obj", "two-squa"), (std::vector<std::string>{"two-squa", "res.obj"}));
  EXPECT_EQ(parted("three-squares", "three-squar"), (std::vector<std::string>{"three-", "squares"}));
  EXPECT_EQ(parted("MetalRough", "MetalRou"), (std::vector<std::string>{"Metal", "Rough"}));
}

TEST(Typeface, KernsAndScales) {
  const Typeface face(Typeface::Weight::Regular, 64), twice(Typeface::Weight::Regular, 128);
  EXPECT_LT(face.width("AV"), face.width("A") + face.width("V") - 1);
  EXPECT_NEAR(twice.width("Hamburg"), 2 * face.width("Hamburg"), 0.5);
  EXPECT_GT(Typeface(Typeface::Weight::Bold, 64).width("Hamburg"), face.width("Hamburg"));
}

// The letter I of a sans-serif font is a rectangle: its ink is its width times its height, at any position.
TEST(Typeface, DrawsCoverageInLinearLight) {
  const Typeface face(Typeface::Weight::Regular, 100);
  const auto ink_of = [&](std::string_view before) {
    Rgba8Image picture(200, 140, white);
    face.draw(picture, 20, 0, std::string(before) + "I", black);
    double sum = 0;
    for (const Rgba8 c : picture.values()) sum += 1 - decode_srgb8(c.r);
    return sum;
  };
  // 201 / 2048 em wide, 1493 / 2048 em high: the outline in the font's own units.
  const double area = (202.0 / 2048) * (1493.0 / 2048) * 100 * 100;
  EXPECT_NEAR(ink_of(""), area, 0.02 * area);
  EXPECT_NEAR(ink_of(" "), ink_of(""), 0.005 * area);
}

TEST(Typeface, ShowsWhatIsNotUtf8AndClips) {
  const Typeface face(Typeface::Weight::Regular, 20);
  for (const std::string_view broken : {"\xff", "\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80"}) {
    Rgba8Image picture(120, 30, white);
    face.draw(picture, 5, 0, broken, black);
    EXPECT_FALSE(is_blank(picture));
  }
  Rgba8Image tiny(4, 4, white);
  face.draw(tiny, -10, -12, "Wide letters, mostly outside", black);  // clipped: the plane asserts the bounds
  EXPECT_FALSE(is_blank(tiny));
}

}  // namespace
}  // namespace zoneplate
