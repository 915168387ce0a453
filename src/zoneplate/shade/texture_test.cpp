#include "zoneplate/shade/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

Rgba8Image noise(int width, int height) {
  Rgba8Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::uint32_t word = hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 7);
      image(x, y) = {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
                     static_cast<std::uint8_t>(word >> 16), static_cast<std::uint8_t>(word >> 24)};
    }
  return image;
}

/// A level's codes, without its border.
std::vector<std::uint32_t> codes_of(const TextureView& view, int level) {
  std::vector<std::uint32_t> codes;
  for (int y = 0; y < view.height[level]; ++y)
    for (int i = 0; i < 4 * view.width[level]; ++i) {
      const std::ptrdiff_t at = std::ptrdiff_t{4} * view.texel(level, 0, y) + i;
      codes.push_back(view.codes8 != nullptr ? std::uint32_t{view.codes8[at]} : view.codes15[at]);
    }
  return codes;
}

/// The length that source texel s and target texel t share, along an axis scaled to n × m units.
std::uint64_t overlap(std::int64_t s, std::int64_t n, std::int64_t t, std::int64_t m) {
  return static_cast<std::uint64_t>(
      std::max(std::int64_t{0}, std::min((s + 1) * m, (t + 1) * n) - std::max(s * m, t * n)));
}

/// The mean of what a target texel covers of the source, by areas.
std::uint32_t mean(const std::vector<std::uint32_t>& source, int w, int h, int x, int y, int c) {
  const int ow = std::max(1, w / 2), oh = std::max(1, h / 2);
  std::uint64_t sum = 0, total = 0;
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      const std::uint64_t area = overlap(i, w, x, ow) * overlap(j, h, y, oh);
      sum += area * source[4 * static_cast<std::size_t>(j * w + i) + static_cast<std::size_t>(c)];
      total += area;
    }
  return static_cast<std::uint32_t>((2 * sum + total) / (2 * total));
}

TEST(Texture, LevelsHalveDownToOneTexel) {
  const Texture texture(Rgba8Image(13, 4), TexelMeaning::Values);
  const TextureView& view = texture.view();
  ASSERT_EQ(view.levels, 4);
  const int widths[] = {13, 6, 3, 1}, heights[] = {4, 2, 1, 1}, offsets[] = {0, 90, 122, 137};
  for (int l = 0; l < 4; ++l) {
    EXPECT_EQ(view.width[l], widths[l]);
    EXPECT_EQ(view.height[l], heights[l]);
    EXPECT_EQ(view.offset[l], offsets[l]);
  }
}

TEST(Texture, EachLevelIsTheRoundedMeanOfTheOneBefore) {
  const int sizes[][2] = {{16, 16}, {8, 32}, {13, 7}, {5, 8}, {1, 9}, {6, 1}, {31, 33}, {12, 20}};
  for (const auto& size : sizes)
    for (const TexelMeaning meaning : {TexelMeaning::Values, TexelMeaning::Color}) {
      const Texture texture(noise(size[0], size[1]), meaning);
      const TextureView& view = texture.view();
      for (int l = 1; l < view.levels; ++l) {
        const auto source = codes_of(view, l - 1), codes = codes_of(view, l);
        for (int y = 0; y < view.height[l]; ++y)
          for (int x = 0; x < view.width[l]; ++x)
            for (int c = 0; c < 4; ++c) {
              const std::size_t at = 4 * static_cast<std::size_t>(y * view.width[l] + x) + static_cast<std::size_t>(c);
              ASSERT_EQ(codes[at], mean(source, view.width[l - 1], view.height[l - 1], x, y, c))
                  << size[0] << "x" << size[1] << " level " << l;
            }
      }
    }
}

TEST(Texture, TheBorderRepeatsTheLevel) {
  const Texture texture(noise(12, 7), TexelMeaning::Values);
  const TextureView& view = texture.view();
  for (int l = 0; l < view.levels; ++l) {
    const int w = view.width[l], h = view.height[l];
    const auto at = [&](int x, int y) { return view.codes8 + std::ptrdiff_t{4} * view.texel(l, x, y); };
    for (int y = -1; y <= h; ++y)
      for (int x = -1; x <= w; ++x)
        EXPECT_EQ(std::memcmp(at(x, y), at((x + w) % w, (y + h) % h), 4), 0) << x << " " << y;
  }
}

TEST(Texture, WhatIsTooLargeIsHalved) {
  Rgba8Image wide(2 * TextureView::max_size + 2, 1, Rgba8{10, 20, 30, 40});
  for (int x = 0; x < wide.width(); x += 2) wide(x, 0).r = 12;
  const Texture texture(wide, TexelMeaning::Values);
  EXPECT_EQ(texture.view().width[0], TextureView::max_size / 2);
  const auto codes = codes_of(texture.view(), 0);
  for (std::size_t i = 0; i < codes.size(); i += 4) ASSERT_TRUE(codes[i] == 11 && codes[i + 1] == 20);
}

TEST(Texture, OneColourStaysThatColour) {
  for (const TexelMeaning meaning : {TexelMeaning::Values, TexelMeaning::Color}) {
    const Texture texture(Rgba8Image(37, 21, Rgba8{200, 100, 1, 77}), meaning);
    const auto first = codes_of(texture.view(), 0);
    for (int l = 0; l < texture.view().levels; ++l) {
      const auto codes = codes_of(texture.view(), l);
      for (std::size_t i = 0; i < codes.size(); ++i) ASSERT_EQ(codes[i], first[i % 4]);
    }
  }
}

TEST(Texture, ColoursAreDecodedAndAlphaIsNot) {
  Rgba8Image ramp(256, 1);
  for (int i = 0; i < 256; ++i) {
    const auto code = static_cast<std::uint8_t>(i);
    ramp(i, 0) = {code, code, code, code};
  }
  const Texture texture(ramp, TexelMeaning::Color);
  for (int i = 0; i < 256; ++i) {
    const double code = i / 255.0;
    const double linear = code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
    const std::uint16_t* const texel = texture.view().codes15 + std::ptrdiff_t{4} * texture.view().texel(0, i, 0);
    EXPECT_NEAR(texel[0], 32767 * linear, 0.51);
    EXPECT_NEAR(texel[3], 32767 * code, 0.51);
  }
}

TEST(Texture, AnEmptyImageIsWhite) {
  const Texture texture(Rgba8Image(), TexelMeaning::Values);
  ASSERT_EQ(texture.view().levels, 1);
  EXPECT_EQ(codes_of(texture.view(), 0), (std::vector<std::uint32_t>{255, 255, 255, 255}));
}

TEST(Texture, ThreadsDoNotMatter) {
  const Rgba8Image image = noise(301, 222);
  std::vector<std::vector<std::uint32_t>> first;
  for (const int threads : {1, 2, 7}) {
    with_threads(threads, [&] {
      const Texture texture(image, TexelMeaning::Color);
      std::vector<std::vector<std::uint32_t>> levels;
      for (int l = 0; l < texture.view().levels; ++l) levels.push_back(codes_of(texture.view(), l));
      if (first.empty()) first = levels;
      EXPECT_EQ(levels, first);
    });
  }
}

}  // namespace
}  // namespace zoneplate
