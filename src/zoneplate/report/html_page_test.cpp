// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/html_page.h"

#include <gtest/gtest.h>

#include "zoneplate/codec/png.h"
#include "zoneplate/image/half.h"

namespace zoneplate {
namespace {

/// The decoder of web/report/bytes.js.
std::vector<std::uint8_t> bytes_of_text(const std::string& text) {
  std::vector<std::uint8_t> out;
  std::uint32_t bits = 0;
  int count = 0;
  const auto digit = [](char c) { return static_cast<std::uint32_t>(c - 33 - (c > '"') - (c > '&') - (c > '<')); };
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bits |= (digit(text[i]) + 91 * digit(text[i + 1])) << count, count += 13;
    for (; count >= 8; bits >>= 8, count -= 8) out.push_back(static_cast<std::uint8_t>(bits & 255));
  }
  return out;
}

TEST(HtmlPage, BytesBecomeTextAndBack) {
  std::vector<std::uint8_t> bytes;
  for (unsigned length = 0; length < 70; ++length) {
    const std::string text = text_of_bytes(bytes);
    EXPECT_EQ(text.find_first_of("\"&< \n"), std::string::npos);
    EXPECT_LE(text.size(), length * 16 / 13 + 2);
    std::vector<std::uint8_t> back = bytes_of_text(text);
    ASSERT_GE(back.size(), bytes.size());
    ASSERT_LE(back.size(), bytes.size() + 1);
    back.resize(bytes.size());
    EXPECT_EQ(back, bytes);
    bytes.push_back(static_cast<std::uint8_t>(length % 3 == 0 ? 255 : length * 37));
  }
}

TEST(HtmlPage, TextsCannotEndTheirElements) {
  const std::string nasty = "</script><b>\"&{{content}}";
  const std::string page = html_page(nasty, Json::Object{{"title", nasty}}, {});
  EXPECT_NE(page.find("<title>&lt;/script&gt;&lt;b&gt;&quot;&amp;{{content}}</title>"), std::string::npos);
  EXPECT_NE(page.find(">{\"title\":\"\\u003c/script>\\u003cb>\\\"&{{content}}\"}</script>"), std::string::npos);
  EXPECT_TRUE(page.ends_with("</html>\n"));
  // The only address is the name of SVG's elements, which is not fetched.
  EXPECT_EQ(page.find("://"), page.rfind("://"));
  EXPECT_NE(page.find("'http://www.w3.org/2000/svg'"), std::string::npos);
}

TEST(HtmlPage, PicturesKeepTheirValues) {
  Rgba8Image codes(7, 5);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x)
      codes(x, y) = {static_cast<std::uint8_t>(30 * x), static_cast<std::uint8_t>(40 * y), 9, 255};
  EXPECT_EQ(decode_png(page_picture(codes).png, "codes").pixels, codes);

  DisplayImage display(2, 1, {51 / 255.0f, 1, 0, 1});
  EXPECT_FALSE(has_16_bits(page_picture(display).png));
  display(1, 0).r = 0.3f;
  const PagePicture fine = page_picture(display);
  EXPECT_EQ(decode_png(fine.png, "fine").pixels16(1, 0).r, 19661);

  LinearImage light(2, 1, {0.5f, 100, -2, 1});
  const PagePicture halves = page_picture(light);
  EXPECT_FALSE(halves.is_rounded);
  const Rgba16 stored = decode_png(halves.png, "halves").pixels16(1, 0);
  EXPECT_EQ(half_value(stored.r), 0.5f);
  EXPECT_EQ(half_value(stored.g), 100);
  EXPECT_EQ(half_value(stored.b), -2);
  light(0, 0).r = 0.1f;
  EXPECT_TRUE(page_picture(light).is_rounded);

  Plane<float> errors(2, 1, 0.2f);
  errors(1, 0) = 7;
  const Rgba8Image map = decode_png(page_errors(errors).png, "errors").pixels;
  EXPECT_EQ(map(0, 0).g, 51);
  EXPECT_EQ(map(1, 0).g, 255);
}

TEST(HtmlPage, IsLittleLargerThanItsPictures) {
  Rgba8Image noise(400, 300);
  std::uint32_t state = 1;
  for (Rgba8& c : noise.values()) {
    state = state * 1664525 + 1013904223;
    c = {static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16), 0, 255};
  }
  const std::vector<PagePicture> pictures(4, page_picture(noise));
  const std::string page = html_page("noise", Json::Object{{"scenes", Json::Array{}}}, pictures);
  EXPECT_LT(static_cast<double>(page.size()), 1.3 * 4 * static_cast<double>(pictures[0].png.size()));
  EXPECT_EQ(page, html_page("noise", Json::Object{{"scenes", Json::Array{}}}, pictures));
}

}  // namespace
}  // namespace zoneplate
