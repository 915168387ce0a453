// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/option/values.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

// The message of the usage error that `parse` throws, or "no error".
template <class Parse>
std::string refusal(Parse parse) {
  try {
    parse();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    return error.what();
  }
  return "no error";
}

TEST(ParseNumber, TakesSignsAndExponentsAndRefusesTheRest) {
  EXPECT_EQ(parse_number("-2.5e-1", -1, 1), -0.25);
  EXPECT_EQ(parse_number("+3", 0, 4), 3);
  for (const char* text : {"", "x", "1x", " 1", "1 ", "nan", "inf", "1e999", "--1", "5", "0x1"})
    EXPECT_EQ(refusal([&] { parse_number(text, 0, 4); }), std::string("'") + text + "' is not a number from 0 to 4");
}

TEST(ParseWhole, KeepsToItsRange) {
  EXPECT_EQ(parse_whole("16", 0, 16), 16);
  for (const char* text : {"", "17", "-1", "1.5", "99999999999"})
    EXPECT_EQ(refusal([&] { parse_whole(text, 0, 16); }),
              std::string("'") + text + "' is not a whole number from 0 to 16");
}

TEST(ParseTriple, TakesThreeNumbers) {
  EXPECT_EQ(parse_triple("-1,2.5,+3"), (double3{-1, 2.5, 3}));
  EXPECT_EQ(parse_triple("500000.1,5200000.1,0").y, 5200000.1);
  for (const char* text : {"", "1,2", "1,2,3,4", "1,,3", "1,2,x", "1 2 3", "1e39,0,0"})
    EXPECT_EQ(refusal([&] { parse_triple(text); }), std::string("'") + text + "' is not three numbers x,y,z");
}

TEST(ParseSize, TakesACommaOrAnX) {
  EXPECT_EQ(parse_size("800,600", 1000), (int2{800, 600}));
  EXPECT_EQ(parse_size("800x600", 1000), (int2{800, 600}));
  EXPECT_EQ(parse_size("512", 1000), (int2{512, 512}));
  EXPECT_EQ(refusal([] { parse_size("1001x1", 1000); }), "1001x1 is too large: a side has at most 1000 pixels");
  for (const char* text : {"", "800x", "x600", "0x5", "5x0", "-5x5", "1x2x3", "1,2x3", "99999999999x1"})
    EXPECT_EQ(refusal([&] { parse_size(text, 1000); }),
              std::string("'") + text + "' is not a size WIDTH,HEIGHT, WIDTHxHEIGHT or SIDE");
}

TEST(ParseColor, TakesHexNamesAndNumbers) {
  EXPECT_EQ(parse_color("#f80"), (float4{1, 136 / 255.0f, 0, 1}));
  EXPECT_EQ(parse_color("#f808"), (float4{1, 136 / 255.0f, 0, 136 / 255.0f}));
  EXPECT_EQ(parse_color("#FF8000"), (float4{1, 128 / 255.0f, 0, 1}));
  EXPECT_EQ(parse_color("#ff800040"), (float4{1, 128 / 255.0f, 0, 64 / 255.0f}));
  EXPECT_EQ(parse_color("0.25,0.5,1"), (float4{0.25f, 0.5f, 1, 1}));
  EXPECT_EQ(parse_color("0,0,0,0.5"), (float4{0, 0, 0, 0.5f}));
  EXPECT_EQ(parse_color("red"), (float4{1, 0, 0, 1}));
  EXPECT_EQ(parse_color("gray"), parse_color("#808080"));
  EXPECT_EQ(parse_color("transparent"), (float4{0, 0, 0, 0}));
  for (const char* text :
       {"", "#", "#f", "#ff", "#fffff", "#ggg", "#+1+1+1", "#-1-1-1", "redd", "1,1", "1,1,2", "1,1,1,1,1", "-1,0,0"})
    EXPECT_NE(refusal([&] { parse_color(text); }).find("is not a colour"), std::string::npos) << text;
}

TEST(ParseBytes, TakesUnitsOf1024) {
  EXPECT_EQ(parse_bytes("1000"), 1000u);
  EXPECT_EQ(parse_bytes("2K"), 2048u);
  EXPECT_EQ(parse_bytes("512M"), std::uint64_t{512} << 20);
  EXPECT_EQ(parse_bytes("4G"), std::uint64_t{4} << 30);
  for (const char* text : {"", "0", "M", "-1", "1.5G", "4T", "18446744073709551616", "99999999999999G"})
    EXPECT_NE(refusal([&] { parse_bytes(text); }).find("is not a size"), std::string::npos) << text;
}

TEST(ParseChoice, NamesTheClosest) {
  EXPECT_EQ(parse_choice("aces", {"none", "aces", "neutral"}), 1u);
  EXPECT_EQ(refusal([] {
              parse_choice("neutrl", {"none", "aces", "neutral"});
            }),
            "'neutrl' is not one of none, aces, neutral; did you mean neutral?");
  EXPECT_EQ(refusal([] { parse_choice("xyzxyzxyz", {"none", "aces"}); }), "'xyzxyzxyz' is not one of none, aces");
}

}  // namespace
}  // namespace zoneplate
