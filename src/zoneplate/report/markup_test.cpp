// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/markup.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace zoneplate
