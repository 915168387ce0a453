// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/figure.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/image/transfer.h"
#include "zoneplate/report/typeface.h"

namespace zoneplate {
namespace {

constexpr Rgba8 paper{255, 255, 255, 255}, ink{32, 32, 32, 255};

Rgba8Image pattern(int width, int height) {
  Rgba8Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image(x, y) = {static_cast<std::uint8_t>(x * 7), static_cast<std::uint8_t>(y * 5), 200, 255};
  return image;
}

bool holds(const Rgba8Image& image, const Rgba8Image& part, int left, int top) {
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x)
      if (image(left + x, top + y) != part(x, y)) return false;
  return true;
}

/// The bounding box of the pixels that differ from the background.
struct Extent {
  int left = 1 << 20, top = 1 << 20, right = -1, bottom = -1;
};
Extent extent_of(const Rgba8Image& image) {
  Extent e;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      if (image(x, y) != paper) {
        e.left = std::min(e.left, x), e.top = std::min(e.top, y);
        e.right = std::max(e.right, x), e.bottom = std::max(e.bottom, y);
      }
  return e;
}

TEST(Figure, KeepsThePixelsOfItsPicturesWhereTheyBelong) {
  const Rgba8Image a = pattern(200, 50), b = pattern(180, 70), c = pattern(90, 20);
  const Rgba8Image figure = compose({.rows = {{{a, ""}, {b, ""}}, {{c, ""}}}}, {.gap_px = 10});
  EXPECT_EQ(figure.width(), 10 + 200 + 10 + 180 + 10);
  EXPECT_EQ(figure.height(), 10 + 70 + 10 + 20 + 10);
  EXPECT_TRUE(holds(figure, a, 10, 10));
  EXPECT_TRUE(holds(figure, b, 220, 10));
  EXPECT_TRUE(holds(figure, c, 10, 90));
  EXPECT_NE(figure(9, 9), paper);  // the outline of the first image
  EXPECT_EQ(figure(8, 8), paper);
  EXPECT_EQ(figure(5, 85), paper);
}

TEST(Figure, APictureThatEndsInPaperHasNoOutline) {
  Rgba8Image plot(300, 40, paper);
  plot(150, 20) = ink;
  const Extent e = extent_of(compose({.rows = {{{plot, ""}}}}, {.gap_px = 10}));
  EXPECT_EQ(e.left, 160);
  EXPECT_EQ(e.right, 160);
  EXPECT_EQ(e.top, 30);
}

TEST(Figure, TransparencyShowsThePaper) {
  const Rgba8Image half(300, 10, {0, 0, 0, 128});
  const Rgba8Image figure = compose({.rows = {{{half, ""}}}}, {.gap_px = 10});
  EXPECT_EQ(figure(100, 15).r, encode_srgb8(1 - 128 / 255.0f));
  EXPECT_EQ(figure(100, 15).a, 255);
}

TEST(Figure, GrowsByItsTitleCaptionsAndText) {
  const Rgba8Image picture = pattern(320, 40);
  const FigureStyle style{.text_px = 16, .gap_px = 10};
  const Typeface text(Typeface::Weight::Regular, 16), title(Typeface::Weight::Bold, 24);
  const auto height = [&](const Figure& f) { return compose(f, style).height(); };
  const int bare = height({.rows = {{{picture, ""}}}});
  EXPECT_EQ(bare, 60);
  EXPECT_EQ(height({.rows = {{{picture, "short"}}}}), bare + 5 + text.leading());
  EXPECT_EQ(height({.rows = {{{picture, "one\ntwo\nthree"}}}}), bare + 5 + 3 * text.leading());
  EXPECT_EQ(height({.title = "T", .rows = {{{picture, ""}}}}), bare + 10 + title.leading());
  EXPECT_EQ(height({.rows = {{{picture, ""}}}, .text = "t"}), bare + 10 + text.leading());
}

TEST(Figure, ACaptionStaysBelowItsPicture) {
  const std::string caption = "Heading\n" + std::string(40, 'm') + " and many more words that need several lines.";
  const Rgba8Image blank(400, 40, paper);
  const Rgba8Image figure = compose({.rows = {{{blank, ""}, {blank, caption}}}}, {.gap_px = 10});
  const Extent e = extent_of(figure);
  EXPECT_GE(e.left, 420);
  EXPECT_LE(e.right, 820);
  EXPECT_GE(e.top, 50);
  EXPECT_LT(e.bottom, figure.height() - 10);
}

TEST(Figure, WithoutPicturesIsStillAPage) {
  const Rgba8Image figure = compose({.title = "Title", .text = "Text"});
  EXPECT_EQ(figure.width(), 20 * 15 + 2 * 16);
  EXPECT_GT(extent_of(figure).right, 30);
  EXPECT_EQ(compose({}).height(), 16);
}

TEST(Figure, EnlargedRepeatsPixels) {
  const Rgba8Image small = pattern(3, 2), large = enlarged(small, 4);
  ASSERT_EQ(large.width(), 12);
  ASSERT_EQ(large.height(), 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 12; ++x) EXPECT_EQ(large(x, y), small(x / 4, y / 4));
}

}  // namespace
}  // namespace zoneplate
