// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/text_scan.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

float nearest(const std::string& text) {
  float value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

TEST(FindNumber, IsTheNearestFloatOfAnyWayOfWritingIt) {
  for (std::uint32_t i = 0; i < 200000; ++i) {
    const float value = std::bit_cast<float>(hash(i, 7));
    if (!std::isfinite(value)) continue;
    const double wide = static_cast<double>(value) * (1 + 1e-9 * static_cast<double>(hash(i, 8)) * 0x1p-32);
    for (const std::string& text : {fmt::format("{}", value), fmt::format("{:.6f}", unit_float(hash(i, 9)) * 100 - 50),
                                    fmt::format("{:.6g}", value), fmt::format("{:.17g}", wide),
                                    fmt::format("{:.9e}", wide), fmt::format("{:.12f}", unit_float(hash(i, 1)))})
      ASSERT_EQ(find_number(text), nearest(text)) << text;
  }
}

TEST(FindNumber, RoundsNumbersBetweenTwoFloatsByTheirLastDigit) {
  // 1 + 2^-24 is halfway between 1 and the next float: ties round to even, and one more digit decides.
  EXPECT_EQ(find_number("1.000000059604644775390625"), 1.0f);
  EXPECT_EQ(find_number("1.00000005960464477"), 1.0f);
  EXPECT_EQ(find_number("1.00000005960464478"), std::nextafter(1.0f, 2.0f));
  EXPECT_EQ(find_number("16777217"), 16777216.0f);
  EXPECT_EQ(find_number("16777219"), 16777220.0f);
  EXPECT_EQ(find_number("16777217.0000001"), 16777218.0f);
}

TEST(ScanNumber, StopsAtTheFirstOtherCharacter) {
  const std::string digits = "908172635445362";
  for (std::size_t n = 1; n <= digits.size(); ++n)
    for (int other = 0; other < 256; ++other) {
      if (other >= '0' && other <= '9') continue;
      for (const std::string& behind : {std::string(), std::string("1234567890"), std::string(10, '\xff')}) {
        const std::string number = "0." + digits.substr(0, n);
        const std::string text = number + static_cast<char>(other) + behind;
        float value = 0;
        const char* const end = scan_number(text.data(), text.data() + text.size(), value);
        const bool is_space = other <= ' ';
        ASSERT_EQ(end, is_space ? text.data() + number.size() : nullptr) << text;
        ASSERT_EQ(value, is_space ? std::stof(number) : 0) << text;
      }
    }
}

TEST(FindNumber, TakesWhatWritersWrite) {
  EXPECT_EQ(find_number("+1.5"), 1.5f);
  EXPECT_EQ(find_number(".5"), 0.5f);
  EXPECT_EQ(find_number("5."), 5.0f);
  EXPECT_EQ(find_number("-1E+2"), -100.0f);
  EXPECT_EQ(find_number("1e-40"), 1e-40f);
  EXPECT_EQ(find_number("1e-999"), 0.0f);
  EXPECT_EQ(find_number("0." + std::string(400, '0') + "1"), 0.0f);
  EXPECT_EQ(find_number("1e999"), INFINITY);
  EXPECT_EQ(find_number("-1e39"), -INFINITY);
  EXPECT_EQ(find_number("inf"), INFINITY);
  for (const char* text : {"nan", "-nan", "1.#IND", "-1.#INF", "1.#QNAN"}) EXPECT_TRUE(std::isnan(*find_number(text)));
  EXPECT_TRUE(std::signbit(*find_number("-0")));
}

TEST(FindNumber, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "-", "+-1", "--1", "1x", "x", "1,5", "1e", "1e+", ".", "0x10", "1/2", "e5"})
    EXPECT_EQ(find_number(text), std::nullopt) << text;
}

std::vector<std::string> lines_of(std::string_view text, char separator = '\n') {
  std::vector<std::string> found;
  TextLines lines(text, 1, separator);
  while (lines.next()) {
    std::string words = fmt::format("{}:", lines.number());
    LineWords line(lines.line());
    for (auto word = line.next(); !word.empty(); word = line.next()) words += fmt::format(" {}", word);
    found.push_back(words);
  }
  return found;
}

TEST(TextLines, EndInEveryWay) {
  using Lines = std::vector<std::string>;
  EXPECT_EQ(lines_of("a b\n\nc"), (Lines{"1: a b", "2:", "3: c"}));
  EXPECT_EQ(lines_of("a\r\nb\r\n"), (Lines{"1: a", "2: b"}));
  EXPECT_EQ(lines_of("a\rb\r", '\r'), (Lines{"1: a", "2: b"}));
  EXPECT_EQ(lines_of("a \\\n b\\\r\nc\nd"), (Lines{"1: a b c", "4: d"}));
  EXPECT_EQ(lines_of("a\\"), (Lines{"1: a"}));
  EXPECT_EQ(lines_of("a\\\n"), (Lines{"1: a"}));
  EXPECT_EQ(lines_of("\t a#1  # b\n#c"), (Lines{"1: a#1", "2:"}));
  EXPECT_EQ(lines_of(""), Lines{});
}

TEST(LineWords, KeepSpacesInTheRest) {
  LineWords words("usemtl \t dark red#2  \r");
  EXPECT_EQ(words.next(), "usemtl");
  EXPECT_EQ(words.rest(), "dark red#2");
  // Control characters become spaces, because names are printed in one line.
  EXPECT_EQ(LineWords(" a\\\nb\tc ").rest(), "a  b c");
}

TEST(FindDouble, IsTheNearestDouble) {
  EXPECT_EQ(find_double("5200000.123"), 5200000.123);
  EXPECT_EQ(find_double("+5.2e6"), 5.2e6);
  EXPECT_EQ(find_double("-0.1"), -0.1);
  EXPECT_TRUE(std::isnan(*find_double("1.#IND")));
  EXPECT_TRUE(std::isinf(*find_double("1e400")));
  EXPECT_EQ(find_double("1e-400"), 0.0);
  for (const char* word : {"", "+", "x", "1x", "--1", "+-1"}) EXPECT_FALSE(find_double(word)) << word;
}

}  // namespace
}  // namespace zoneplate
