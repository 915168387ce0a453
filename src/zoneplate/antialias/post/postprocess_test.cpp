// SPDX-License-Identifier: Apache-2.0
// Properties of all methods that filter the display-referred image.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate::antialias {
namespace {

/// A method, and the maximum fraction of an intricate chart's pixels, in thousandths, that may differ if the chart is
/// mirrored left to right, upside down or on its diagonal. If it is not 0, the definition of the method prefers one
/// side. `border` is the number of pixels of a small image that may differ from those of an image that continues its
/// border, beside pixels at which an edge meets the border: a method may end an edge there.
struct Case {
  const char* text;
  int left_right, up_down, diagonal, border = 0;
};
const Case cases[] = {
    // Of equal gradients the upper or left one is used, and of equal directions the horizontal one.
    {"fxaa", 0, 0, 4},
    {"fxaa:preset=39,threshold=overkill,mix=light", 0, 0, 4},
    // The offset of the north-east luma rotates the direction of horizontal and vertical edges.
    {"fxaa:preset=console", 70, 70, 90},
    // Diagonals are searched from top edges, and of equal axes the vertical one is blended.
    {"smaa", 16, 14, 15},
    {"smaa:preset=medium,edges=color", 6, 6, 3, 2},
    {"smaa:preset=ultra", 18, 15, 16},
    // The contrast of a border is evaluated at the pixel on its right or below it.
    {"mlaa", 5, 6, 0},
    {"mlaa:mix=codes,steps=8", 5, 6, 0},
    {"mlaa:kind=reshetov", 0, 0, 0, 4},
    {"cmaa2", 0, 0, 0},
    {"cmaa2:preset=ultra,sharp=1", 0, 0, 0, 5},
    // The horizontal blur has weight 1, the vertical one 1/2; of the long blurs the horizontal one is applied last.
    {"dlaa", 0, 0, 65},
    // Of equal gradients the upper or left one is used, and of equal directions the horizontal one.
    {"ddaa", 4, 2, 4},
    {"ddaa:threshold=extreme", 4, 2, 4},
};

DisplayImage shown(const Rgba8Image& codes) {
  DisplayImage image(codes.width(), codes.height());
  std::ranges::transform(codes.values(), image.values().begin(), [](Rgba8 c) {
    return Display{static_cast<float>(c.r) / 255, static_cast<float>(c.g) / 255, static_cast<float>(c.b) / 255,
                   static_cast<float>(c.a) / 255};
  });
  return image;
}

DisplayImage finished(const char* text, DisplayImage image) {
  return make_resolver(methods(), text)->post_process(std::move(image), Frame{});
}

Rgba8Image filtered(const char* text, const Rgba8Image& codes) { return quantize8(finished(text, shown(codes))); }

template <class From>
Rgba8Image moved(const Rgba8Image& image, int width, int height, const From& from) {
  return make_codes(width, height, [&](int x, int y) {
    const auto [i, j] = from(x, y);
    return image(i, j);
  });
}

TEST(PostProcess, ConstantPicturesKeepTheirBits) {
  for (const Case& c : cases)
    for (const Display value :
         {Display{0.1234567f, 0.7f, 1, 1}, Display{0, 0, 0, 0}, Display{0.3f, 0.2f, 0.9f, 0.4f}}) {
      const DisplayImage image(70, 41, value);
      EXPECT_EQ(finished(c.text, image), image) << c.text;
    }
}

// An image of any size gives the same result as within a larger one that continues its border pixels.
TEST(PostProcess, PicturesOfAnySizeAreThoseOfTheirContinuation) {
  for (const Case& c : cases)
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 3}, {7, 8}, {31, 17}, {65, 5}, {0, 0}}) {
      const Rgba8Image image = random_shapes(width, height, 3);
      const Rgba8Image out = filtered(c.text, image);
      ASSERT_EQ(out.width(), width);
      ASSERT_EQ(out.height(), height);
      if (image.empty()) continue;
      const int w = width, h = height;
      constexpr int margin = 80;
      const Rgba8Image continued =
          filtered(c.text, moved(image, w + 2 * margin, h + 2 * margin, [&](int x, int y) {
                     return std::pair{std::clamp(x - margin, 0, w - 1), std::clamp(y - margin, 0, h - 1)};
                   }));
      int differing = 0;
      for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
          if (out(x, y) == continued(x + margin, y + margin)) continue;
          ++differing;
          EXPECT_NEAR(out(x, y).g, continued(x + margin, y + margin).g, 8) << c.text << " at " << x << ", " << y;
        }
      EXPECT_LE(differing, c.border) << c.text << " " << width << "x" << height;
    }
}

TEST(PostProcess, SomethingIsDoneAndNotTooMuch) {
  const Rgba8Image image = random_shapes(160, 120, 4);
  for (const Case& c : cases) {
    const int changed = count_differing(filtered(c.text, image), image, 0);
    EXPECT_GT(changed, 160 * 120 / 50) << c.text;
    EXPECT_LT(changed, 160 * 120 * 2 / 3) << c.text;
  }
}

TEST(PostProcess, ThreadsLeaveNoTrace) {
  const Rgba8Image image = random_shapes(150, 130, 5);
  for (const Case& c : cases) {
    Rgba8Image expected;
    with_threads(1, [&] { expected = filtered(c.text, image); });
    for (const int threads : {2, 5})
      with_threads(threads, [&] { EXPECT_EQ(filtered(c.text, image), expected) << c.text; });
  }
}

TEST(PostProcess, ADisplacedPictureGivesADisplacedResult) {
  const Rgba8Image chart = random_shapes(64, 48, 6);
  const auto placed = [&](int dx, int dy) {
    return make_codes(340, 330, [&](int x, int y) {
      const int i = x - dx, j = y - dy;
      return i >= 0 && j >= 0 && i < 64 && j < 48 ? chart(i, j) : Rgba8{90, 100, 20};
    });
  };
  for (const Case& c : cases) {
    const Rgba8Image a = filtered(c.text, placed(138, 140)), b = filtered(c.text, placed(141, 145));
    for (int y = 135; y < 193; ++y)
      for (int x = 133; x < 207; ++x) ASSERT_EQ(a(x, y), b(x + 3, y + 5)) << c.text << " " << x << "," << y;
  }
}

TEST(PostProcess, ACropWithItsHaloEqualsTheWhole) {
  constexpr int width = 330, height = 310, left = 140, top = 131, right = 190, bottom = 178;
  const Rgba8Image image = random_shapes(width, height, 7);
  for (const Case& c : cases) {
    const int halo = make_resolver(methods(), c.text)->request({}).halo;
    ASSERT_GT(halo, 0);
    const int x0 = std::max(0, left - halo), y0 = std::max(0, top - halo);
    const int w = std::min(width, right + halo) - x0, h = std::min(height, bottom + halo) - y0;
    const Rgba8Image part = moved(image, w, h, [&](int x, int y) { return std::pair{x + x0, y + y0}; });
    const Rgba8Image whole = filtered(c.text, image), out = filtered(c.text, part);
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) ASSERT_EQ(out(x - x0, y - y0), whole(x, y)) << c.text << " " << x << "," << y;
  }
}

TEST(PostProcess, MirroredPicturesGiveMirroredResults) {
  constexpr int size = 160;
  const Rgba8Image image = random_shapes(size, size, 8);
  const auto left_right = [](int x, int y) { return std::pair{size - 1 - x, y}; };
  const auto up_down = [](int x, int y) { return std::pair{x, size - 1 - y}; };
  const auto diagonal = [](int x, int y) { return std::pair{y, x}; };
  for (const Case& c : cases) {
    const Rgba8Image out = filtered(c.text, image);
    const auto differing = [&](const auto& mirror) {
      const Rgba8Image mirrored = filtered(c.text, moved(image, size, size, mirror));
      return count_differing(mirrored, moved(out, size, size, mirror), 0) * 1000 / (size * size);
    };
    EXPECT_LE(differing(left_right), c.left_right) << c.text;
    EXPECT_LE(differing(up_down), c.up_down) << c.text;
    EXPECT_LE(differing(diagonal), c.diagonal) << c.text;
  }
}

/// The filters of images, of the table with their defaults and of the cases.
std::vector<std::string> filters() {
  std::vector<std::string> out;
  for (const Method& method : methods()) {
    const Request request = make_resolver(methods(), method.name)->request({});
    if (request.is_display_referred && request.samples.size() == 1 && !request.draw && !request.planes.any())
      out.emplace_back(method.name);
  }
  for (const Case& c : cases) out.emplace_back(c.text);
  return out;
}

// Discs of one colour and of two, with hard and with soft outlines, on transparency that hides another colour: what
// becomes transparent has no colour that the disc does not have.
TEST(PostProcess, TransparentPicturesHaveNoColouredRim) {
  ASSERT_GE(filters().size(), std::size(cases) + 7);
  const std::pair<Rgba8, Rgba8> colors[] = {{{255, 180, 60}, {255, 180, 60}},
                                            {{2, 2, 2}, {2, 2, 2}},
                                            {{250, 250, 250}, {250, 250, 250}},
                                            {{220, 30, 40}, {200, 20, 90}}};
  for (const auto& [left, right] : colors)
    for (const bool is_soft : {false, true}) {
      const Rgba8Image disc = make_codes(48, 48, [&, left = left, right = right](int x, int y) {
        const float distance = std::sqrt(static_cast<float>((x - 23) * (x - 23) + (y - 24) * (y - 24)));
        const float coverage = std::clamp(17.4f - distance, 0.0f, 1.0f);
        Rgba8 c = x < 20 ? left : right;
        c.a = static_cast<std::uint8_t>((is_soft ? coverage : coverage > 0.5f ? 1 : 0) * 255 + 0.5f);
        return c.a > 0 ? c : Rgba8{0, 255, 0, 0};
      });
      for (const std::string& text : filters()) {
        const Rgba8Image out = filtered(text.c_str(), disc);
        int mixed = 0, changed = 0;
        for (std::size_t i = 0; i < out.values().size(); ++i) {
          const Rgba8 p = out.values()[i];
          mixed += p.a > 0 && p.a < 255, changed += p != disc.values()[i];
          if (p.a == 0) continue;
          for (const auto channel : {&Rgba8::r, &Rgba8::g, &Rgba8::b}) {
            EXPECT_GE(p.*channel + 2, std::min(left.*channel, right.*channel)) << text << ' ' << int{p.a};
            EXPECT_LE(p.*channel - 2, std::max(left.*channel, right.*channel)) << text << ' ' << int{p.a};
          }
        }
        EXPECT_GT(mixed, 40) << text;
        if (!is_soft) {
          EXPECT_GT(changed, 40) << text;
        }
      }
    }
}

}  // namespace
}  // namespace zoneplate::antialias
