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

}  // namespace
}  // namespace zoneplate
