// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/utf8.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

TEST(Utf8, AppendedCodePointsAreTakenAgain) {
  std::string text;
  const auto use_each = [](auto use) {
    for (char32_t code = 0; code < 0x110000; ++code)
      if (code >> 11 != 0x1b) use(code);
  };
  use_each([&](char32_t code) { append_utf8(text, code); });
  EXPECT_EQ(text.size(), 0x80u + 2 * (0x800 - 0x80) + 3 * (0xf800 - 0x800) + 4 * 0x100000);
  std::string_view rest = text;
  use_each([&](char32_t code) { ASSERT_EQ(take_code_point(rest), code); });
  EXPECT_TRUE(rest.empty());
}

TEST(Utf8, ReplacesEachByteThatIsNotUtf8) {
  std::string_view text =
      "a\xff\xe2\x82\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80";  // truncated, overlong, a surrogate, too large
  EXPECT_EQ(take_code_point(text), U'a');
  for (int i = 0; i < 12; ++i) EXPECT_EQ(take_code_point(text), replacement_character) << i;
  EXPECT_TRUE(text.empty());
}

TEST(Utf8, PrintableTextHasNoControlCharacters) {
  EXPECT_EQ(printable("plain, Größe, 椅子"), "plain, Größe, 椅子");
  EXPECT_EQ(printable("a\x1b]0;b\x07\x1b[31mc\x7f\n\t\r"), "a?]0;b??[31mc????");
  EXPECT_EQ(printable("\xc2\x85\xc2\x9b"
                      "1m\xc2\xa0"),
            "??1m\xc2\xa0");  // C1, and a space that is none
  EXPECT_EQ(printable("\x9b"
                      "1m\xe9"),
            "?1m\xe9");  // C1 as one byte, and a letter of Latin-1
  EXPECT_EQ(printable("\u202egnp.exe\u2028\u2066"), "?gnp.exe??");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "?");
  EXPECT_EQ(printable_lines("a\n\tb\x1b\r\n"), "a\n\tb??\n");
}

}  // namespace
}  // namespace zoneplate
