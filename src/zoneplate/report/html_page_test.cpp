// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/html_page.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "zoneplate/base/utf8.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/image/half.h"
#include "zoneplate/report/html_page_for_test.h"

namespace zoneplate {

std::vector<std::uint8_t> bytes_of_text(const std::string& text) {
  std::vector<std::uint8_t> out;
  constexpr unsigned left_out[] = {0, '\n', '\r', '<'};
  unsigned bits = 0;
  int count = 0;
  const auto add = [&](unsigned seven) {
    bits = (bits << 7 | seven) & 0x3fff, count += 7;
    if (count >= 8) out.push_back(static_cast<std::uint8_t>(bits >> (count -= 8)));
  };
  for (std::string_view rest = text; !rest.empty();) {
    const char32_t code = take_code_point(rest);
    add(code < 128 ? code : left_out[code >> 7 & 3]);
    if (code >= 512 && code < 1024) add(code & 127);
  }
  return out;
}

std::vector<std::string> parts_of_page(const std::string& page) {
  const std::string mark = "id=\"viewer\">";
  const std::size_t begin = page.find(mark) + mark.size();
  const std::vector<std::uint8_t> packed = bytes_of_text(page.substr(begin, page.find("</script>", begin) - begin));
  std::string out(std::size_t{1} << 24, '\0');
  uLongf size = out.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &size, packed.data(), packed.size()), Z_OK);
  out.resize(size);
  std::vector<std::string> parts(1);
  for (const char c : out)
    if (c == '\0')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::string content_of_page(const std::string& page) { return parts_of_page(page).back(); }

namespace {

TEST(HtmlPage, BytesBecomeTextAndBack) {
  const auto check = [](const std::vector<std::uint8_t>& bytes) {
    const std::string text = text_of_bytes(bytes);
    EXPECT_EQ(text.find_first_of(std::string("\0\n\r<", 4)), std::string::npos);
    EXPECT_LE(text.size(), (bytes.size() * 8 + 6) / 7 + 1);
    EXPECT_EQ(bytes_of_text(text), bytes);
  };
  for (const unsigned fill : {0u, 10u, 13u, 21u, 60u, 121u, 255u}) {
    std::vector<std::uint8_t> bytes;
    for (unsigned length = 0; length < 70; ++length) {
      check(bytes);
      bytes.push_back(static_cast<std::uint8_t>(length % 3 == 0 ? fill : length * 37 * fill));
    }
  }
}

TEST(HtmlPage, TextsCannotEndTheirElements) {
  const std::string nasty = "</script><b>\"&{{content}}";
  const std::string page = html_page(nasty, Json::Object{{"title", nasty}}, {});
  EXPECT_NE(page.find("<title>&lt;/script&gt;&lt;b&gt;&quot;&amp;{{content}}</title>"), std::string::npos);
  EXPECT_EQ(content_of_page(page), "{\"title\":\"</script><b>\\\"&{{content}}\"}");
  EXPECT_TRUE(page.ends_with("</html>\n"));
  // The only address is the name of SVG's elements, which is not fetched.
  for (const std::string_view part : {viewer_page, viewer_style}) EXPECT_EQ(part.find("://"), std::string::npos);
  EXPECT_EQ(viewer_script.find("://"), viewer_script.rfind("://"));
  EXPECT_NE(viewer_script.find("'http://www.w3.org/2000/svg'"), std::string::npos);
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

TEST(HtmlPage, HasTheModulesAndColoursThatItsDataNeed) {
  const Json table = page_table({{"a", "b"}, {{"1", "2"}}}, ""), none = Json::Array{};
  const Json named = Json::Object{{"title", "\"tables\":[{\"plot\":{"}, {"tables", none}};
  const Json scene = Json::Object{{"tables", Json::Array{table}}, {"plot", Json::Object{{"x", 1}}}};
  const PagePicture errors = page_errors(Plane<float>(2, 1, 0.5f));
  const auto has = [](const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; };
  const std::vector<std::string> plain = parts_of_page(html_page("", named, {})),
                                 whole = parts_of_page(
                                     html_page("", Json::Object{{"scenes", Json::Array{scene}}}, {&errors, 1}));
  for (const std::string_view function : {"function makeTable(", "function makePlot("}) {
    EXPECT_FALSE(has(plain[1], function)) << function;
    EXPECT_TRUE(has(whole[1], function)) << function;
  }
  EXPECT_EQ(plain[2].size(), 0u);
  EXPECT_EQ(whole[2].size(), 6u * 256);
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
  const std::string empty = html_page("noise", Json::Object{{"scenes", Json::Array{}}}, {});
  EXPECT_LT(empty.size(), 23000u);
  EXPECT_LT(static_cast<double>(page.size() - empty.size()), 1.145 * 4 * static_cast<double>(pictures[0].png.size()));
  EXPECT_EQ(page, html_page("noise", Json::Object{{"scenes", Json::Array{}}}, pictures));
}

}  // namespace
}  // namespace zoneplate
