// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/markup.h"

#include <gtest/gtest.h>

#include <vector>

namespace zoneplate {
namespace {

TEST(Markup, EscapesWhatXmlReserves) {
  EXPECT_EQ(escape_markup("a<b & \"c\">d"), "a&lt;b &amp; &quot;c&quot;&gt;d");
  EXPECT_EQ(escape_markup("Größe 8 × 8, 日本, 😀"), "Größe 8 × 8, 日本, 😀");
}

TEST(Markup, ReplacesWhatXmlForbids) {
  const std::string bad = "\xef\xbf\xbd";
  EXPECT_EQ(escape_markup("a\x01"
                          "b\x1b"),
            "a" + bad + "b" + bad);
  EXPECT_EQ(escape_markup("\xff.png"), bad + ".png");
  EXPECT_EQ(escape_markup("\xc3"), bad);                      // truncated
  EXPECT_EQ(escape_markup("\xc0\xaf"), bad + bad);            // overlong
  EXPECT_EQ(escape_markup("\xed\xa0\x80"), bad + bad + bad);  // a surrogate
  EXPECT_EQ(escape_markup("\xef\xbf\xbf"), bad);              // U+FFFF
  EXPECT_EQ(escape_markup("a\tb\nc"), "a\tb\nc");
}

// RFC 4648, section 10.
TEST(Markup, DataUrisAreBase64) {
  const auto uri = [](const std::string& text) {
    return data_uri("x/y", std::vector<std::uint8_t>(text.begin(), text.end())).substr(16);
  };
  EXPECT_EQ(uri(""), "");
  EXPECT_EQ(uri("f"), "Zg==");
  EXPECT_EQ(uri("fo"), "Zm8=");
  EXPECT_EQ(uri("foo"), "Zm9v");
  EXPECT_EQ(uri("foob"), "Zm9vYg==");
  EXPECT_EQ(uri("fooba"), "Zm9vYmE=");
  EXPECT_EQ(uri("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace zoneplate
