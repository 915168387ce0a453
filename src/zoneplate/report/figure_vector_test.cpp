// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/figure_vector.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <string>

#include "zoneplate/codec/png.h"
#include "zoneplate/formats/import/model_path.h"

namespace zoneplate {
namespace {

Rgba8Image gradient(int width, int height) {
  Rgba8Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image(x, y) = {static_cast<std::uint8_t>(x * 7), static_cast<std::uint8_t>(y * 5), 200, 255};
  return image;
}

FigurePage page() {
  return {.figure = {.title = "Title & more", .rows = {{{gradient(130, 20), "Head\nwords below"}}}, .text = "the text"},
          .style = {}};
}

std::string between(const std::string& text, const std::string& before, const std::string& after,
                    std::size_t from = 0) {
  const std::size_t begin = text.find(before, from);
  if (begin == std::string::npos) return "";
  const std::size_t start = begin + before.size();
  return text.substr(start, text.find(after, start) - start);
}

TEST(FigureVector, AnSvgHasThePixelsOfItsImagesAndTheLinesOfItsText) {
  const std::string svg = figure_svg(page());
  const auto png = decode_base64(between(svg, "base64,", "\""));
  ASSERT_TRUE(png);
  EXPECT_EQ(decode_png(*png, "embedded").pixels, gradient(130, 20));
  for (const char* line : {"aria-label=\"Title &amp; more\"", "aria-label=\"Head\"", "aria-label=\"the text\""})
    EXPECT_NE(svg.find(line), std::string::npos) << line;
  const Rgba8Image image = compose(page().figure);
  EXPECT_EQ(between(svg, "width=\"", "\""), std::to_string(image.width()));
  EXPECT_EQ(between(svg, "height=\"", "\""), std::to_string(image.height()));
}

TEST(FigureVector, ALargerPageHasTheFigureInItsMiddle) {
  FigurePage large = page();
  const Rgba8Image image = compose(large.figure);
  const auto x = [](const std::string& svg) { return std::stoi(between(svg, "<image x=\"", "\"")); };
  const int before = x(figure_svg(large));
  large.size = {image.width() + 100, image.height() + 60};
  EXPECT_EQ(x(figure_svg(large)), before + 50);
}

TEST(FigureVector, APdfHasItsObjectsWhereItsTableSays) {
  const FigurePage pages[] = {page(), page()};
  const std::vector<std::uint8_t> bytes = figures_pdf(pages);
  EXPECT_EQ(bytes, figures_pdf(pages));
  const std::string pdf(bytes.begin(), bytes.end());
  EXPECT_TRUE(pdf.starts_with("%PDF-1.4\n"));
  EXPECT_TRUE(pdf.ends_with("%%EOF\n"));
  EXPECT_NE(pdf.find("/Count 2"), std::string::npos);
  const std::size_t table = std::stoul(between(pdf, "startxref\n", "\n"));
  ASSERT_EQ(pdf.substr(table, 5), "xref\n");
  const int count = std::stoi(between(pdf, "xref\n0 ", "\n", table));
  const std::size_t first = pdf.find("\n", table + 5) + 1;
  for (int i = 1; i < count; ++i) {
    const std::size_t place = std::stoul(pdf.substr(first + static_cast<std::size_t>(20 * i), 10));
    const std::string head = std::to_string(i) + " 0 obj\n";
    EXPECT_EQ(pdf.substr(place, head.size()), head);
  }
}

TEST(FigureVector, APdfHasThePixelsOfItsImages) {
  const FigurePage one = page();
  const std::vector<std::uint8_t> bytes = figures_pdf({&one, 1});
  const std::string pdf(bytes.begin(), bytes.end());
  const std::size_t image = pdf.find("/Subtype /Image /Width 130 /Height 20");
  ASSERT_NE(image, std::string::npos);
  const std::size_t start = pdf.find("stream\n", image) + 7;
  std::vector<std::uint8_t> rgb(130 * 20 * 3);
  uLongf size = rgb.size();
  ASSERT_EQ(uncompress(rgb.data(), &size, bytes.data() + start, std::stoul(between(pdf, "/Length ", " ", image))),
            Z_OK);
  ASSERT_EQ(size, rgb.size());
  const Rgba8Image expected = gradient(130, 20);
  for (std::size_t i = 0; i < expected.values().size(); ++i) {
    const Rgba8 c = expected.values()[i];
    EXPECT_EQ((std::vector<std::uint8_t>{rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]}),
              (std::vector<std::uint8_t>{c.r, c.g, c.b}));
  }
}

}  // namespace
}  // namespace zoneplate
