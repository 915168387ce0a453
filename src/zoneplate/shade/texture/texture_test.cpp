// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/half.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/texture/noise_for_test.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

/// A level's codes, without its border.
std::vector<std::uint32_t> codes_of(const TextureView& view, int level) {
  std::vector<std::uint32_t> codes;
  for (int y = 0; y < view.height[level]; ++y)
    for (int i = 0; i < 4 * view.width[level]; ++i) {
      const std::ptrdiff_t at = std::ptrdiff_t{4} * view.texel(level, 0, y) + i;
      codes.push_back(view.unorm8 != nullptr ? std::uint32_t{view.unorm8[at]} : view.unorm15[at]);
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
      const Texture texture(noise(size[0], size[1], 7), meaning);
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

void expect_repeating_borders(int width, int height) {
  const Texture texture(noise(width, height, 7), TexelMeaning::Values);
  const TextureView& view = texture.view();
  for (int l = 0; l < view.levels; ++l) {
    const int w = view.width[l], h = view.height[l];
    const auto at = [&](int x, int y) { return view.unorm8 + std::ptrdiff_t{4} * view.texel(l, x, y); };
    for (int y = -1; y <= h; ++y)
      for (int x = -1; x <= w; ++x)
        EXPECT_EQ(std::memcmp(at(x, y), at((x + w) % w, (y + h) % h), 4), 0) << x << " " << y;
  }
}

TEST(Texture, TheBorderRepeatsTheLevel) { expect_repeating_borders(12, 7); }

TEST(Texture, TheBorderOfPaddedRowsRepeatsTheLevel) {
  EXPECT_GT(RowPitch::of(1024), 1024 + RowPitch::border);
  expect_repeating_borders(1024, 6);
}

// A first-level cache of 32 KiB has 64 sets of eight lines of 64 bytes.
TEST(Texture, ABlockOfPaddedRowsFitsTheFirstLevelCache) {
  for (const int width : {512, 1024, 2048, 4096, 8192}) {
    int lines_of_set[64] = {};
    for (int y = 0; y < 64; ++y) {
      const int first = 4 * y * RowPitch::of(width), last = first + 4 * 64 - 1;
      for (int line = first / 64; line <= last / 64; ++line) ++lines_of_set[line % 64];
    }
    EXPECT_LE(*std::max_element(std::begin(lines_of_set), std::end(lines_of_set)), 8) << width;
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

TEST(Texture, WhatIsTooLargeIsHalvedInLight) {
  Rgba8Image wide(TextureView::max_size + 2, 3, Rgba8{0, 0, 0, 255});
  Rgba16Image high(2, 2 * TextureView::max_size + 2, Rgba16{0, 0, 0, 65535});
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < wide.width(); x += 2) wide(x, y).r = 255;
  for (int y = 0; y < high.height(); y += 2) high(0, y).g = 65535;
  const Texture columns(wide, TexelMeaning::Color), rows(high, TexelMeaning::Color);
  EXPECT_EQ(columns.view().width[0], TextureView::max_size / 2 + 1);
  EXPECT_EQ(columns.view().height[0], 3);
  const auto codes = codes_of(columns.view(), 0);
  for (std::size_t i = 0; i < codes.size(); i += 4) ASSERT_TRUE(codes[i] == 16384 && codes[i + 1] == 0);
  // 65,538 rows become 32,769 and then 16,384.
  EXPECT_EQ(rows.view().width[0], 2);
  EXPECT_EQ(rows.view().height[0], TextureView::max_size / 2);
  for (int y = 0; y < rows.view().height[0]; ++y) {
    const float* const texel = rows.view().values + std::ptrdiff_t{4} * rows.view().texel(0, 0, y);
    ASSERT_TRUE(texel[1] == 0.5f && texel[5] == 0 && texel[3] == 1) << y;
  }
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
    const std::uint16_t* const texel = texture.view().unorm15 + std::ptrdiff_t{4} * texture.view().texel(0, i, 0);
    EXPECT_NEAR(texel[0], 32767 * linear, 0.51);
    EXPECT_NEAR(texel[3], 32767 * code, 0.51);
  }
}

/// A level's floats or half floats, without its border.
std::vector<float> values_of(const TextureView& view, int level) {
  std::vector<float> values;
  for (int y = 0; y < view.height[level]; ++y)
    for (int i = 0; i < 4 * view.width[level]; ++i) {
      const std::ptrdiff_t at = std::ptrdiff_t{4} * view.texel(level, 0, y) + i;
      values.push_back(view.halves != nullptr ? half_value(view.halves[at].bits) : view.values[at]);
    }
  return values;
}

TEST(Texture, LightAndSixteenBitsAreFloats) {
  constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const Plane<float4> light(1, 1, float4{1e4f, 0.25f, 3, 0.5f}), odd(1, 1, float4{infinity, -1, nan, 7});
  const Rgba16Image deep(1, 1, Rgba16{1, 32768, 65535, 32769});
  const auto texel = [](const TexelImage& image, TexelMeaning meaning) {
    return values_of(Texture(image, meaning).view(), 0);
  };
  const auto color = TexelMeaning::Color, data = TexelMeaning::Values;
  EXPECT_EQ(texel(light, color), (std::vector<float>{1e4f, 0.25f, 3, 0.5f}));
  EXPECT_EQ(texel(light, data), (std::vector<float>{1, 0.25f, 1, 0.5f}));
  EXPECT_EQ(texel(odd, color), (std::vector<float>{1e9f, 0, 0, 1}));
  EXPECT_EQ(texel(odd, data), (std::vector<float>{1, 0, 0, 1}));
  const auto value = [](int code) { return static_cast<float>(code / 65535.0); };
  EXPECT_EQ(texel(deep, data), (std::vector<float>{value(1), value(32768), 1, value(32769)}));
  const std::vector<float> decoded = texel(deep, color);
  EXPECT_NEAR(decoded[0], 1 / 65535.0 / 12.92, 1e-12);
  EXPECT_NEAR(decoded[1], std::pow((32768 / 65535.0 + 0.055) / 1.055, 2.4), 2e-8);
  EXPECT_EQ(decoded[2], 1);
  EXPECT_EQ(decoded[3], value(32769));
}

/// The image with every channel rounded to half floats.
Plane<float4> rounded_to_halves(Plane<float4> image) {
  for (float4& p : image.values())
    for (float* const v : {&p.x, &p.y, &p.z, &p.w}) *v = half_value(half_bits(*v));
  return image;
}

TEST(Texture, HalfFloatsStoreWhatTheyRepresentExactly) {
  const auto stores_halves = [](float4 texel, TexelMeaning meaning = TexelMeaning::Color) {
    Plane<float4> image(40, 40, float4{1, 2, 3, 1});
    image(17, 33) = texel;
    const Texture texture(image, meaning);
    const TextureView& view = texture.view();
    EXPECT_NE(view.halves != nullptr, view.values != nullptr);
    const float4 expected = meaning == TexelMeaning::Color ? texel : float4{1, 1, 1, 1};
    const std::size_t at = 4 * (33 * 40 + 17);
    EXPECT_EQ(values_of(view, 0)[at], expected.x);
    EXPECT_EQ(values_of(view, 0)[at + 3], expected.w);
    return view.halves != nullptr;
  };
  EXPECT_TRUE(stores_halves({65504, 0x1p-24f, 0, 0.5f}));
  EXPECT_TRUE(stores_halves({0x1p-14f, 2049 - 1, 1e4f, 1}));
  EXPECT_FALSE(stores_halves({65536, 1, 1, 1}));
  EXPECT_FALSE(stores_halves({0x1p-25f, 1, 1, 1}));
  EXPECT_FALSE(stores_halves({2049, 1, 1, 1}));
  EXPECT_FALSE(stores_halves({1, 1, 1, 0.1f}));
  // Data are at most 1, which is a half float.
  EXPECT_TRUE(stores_halves({65536, 1, 1, 1}, TexelMeaning::Values));
}

/// Channel c of texel t of level l: the mean of the area that it covers of the level before, whose texels are `source`.
template <class Values>
double mean_by_area(const TextureView& view, int l, const Values& source, int t, int c) {
  const int w = view.width[l - 1], h = view.height[l - 1];
  double sum = 0, total = 0;
  for (int s = 0; s < w * h; ++s) {
    const auto area = static_cast<double>(overlap(s % w, w, t % view.width[l], view.width[l]) *
                                          overlap(s / w, h, t / view.width[l], view.height[l]));
    sum += area * source[static_cast<std::size_t>(4 * s + c)], total += area;
  }
  return sum / total;
}

TEST(Texture, LevelsOfHalfFloatsAreRoundedMeansByArea) {
  const int sizes[][2] = {{16, 16}, {13, 7}, {1, 9}, {6, 1}, {31, 33}};
  for (const auto& size : sizes) {
    const Plane<float4> image = rounded_to_halves(bright_noise(size[0], size[1]));
    const Texture texture(image, TexelMeaning::Color);
    const TextureView& view = texture.view();
    ASSERT_NE(view.halves, nullptr);
    for (int l = 1; l < view.levels; ++l) {
      const auto source = values_of(view, l - 1), values = values_of(view, l);
      for (int t = 0; t < view.width[l] * view.height[l]; ++t)
        for (int c = 0; c < 4; ++c) {
          const double mean = mean_by_area(view, l, source, t, c);
          const float expected = half_value(half_bits(static_cast<float>(mean)));
          ASSERT_EQ(values[static_cast<std::size_t>(4 * t + c)], expected)
              << size[0] << "x" << size[1] << " level " << l;
        }
    }
  }
}

TEST(Texture, LevelsOfFloatsAreMeansByArea) {
  const int sizes[][2] = {{16, 16}, {13, 7}, {1, 9}, {6, 1}, {31, 33}};
  for (const auto& size : sizes) {
    const Texture texture(bright_noise(size[0], size[1]), TexelMeaning::Color);
    const TextureView& view = texture.view();
    ASSERT_NE(view.values, nullptr);
    for (int l = 1; l < view.levels; ++l) {
      const auto source = values_of(view, l - 1), values = values_of(view, l);
      for (int t = 0; t < view.width[l] * view.height[l]; ++t)
        for (int c = 0; c < 4; ++c) {
          const double mean = mean_by_area(view, l, source, t, c);
          const float value = values[static_cast<std::size_t>(4 * t + c)];
          ASSERT_NEAR(value, mean, mean * 0x1p-24 * 1.001) << size[0] << "x" << size[1] << " level " << l;
        }
    }
  }
}

TEST(Texture, AnImageThatIsGivenIsFreed) {
  TexelImage image = noise(37, 20, 7);
  const Texture kept(image, TexelMeaning::Color);
  EXPECT_FALSE(image.empty());
  const Texture taken(std::move(image), TexelMeaning::Color);
  EXPECT_TRUE(image.empty());
  ASSERT_EQ(taken.view().levels, kept.view().levels);
  for (int l = 0; l < kept.view().levels; ++l) EXPECT_EQ(codes_of(taken.view(), l), codes_of(kept.view(), l));
}

TEST(Texture, AnEmptyImageIsWhite) {
  for (const TexelImage& image : {TexelImage(), TexelImage(Rgba16Image()), TexelImage(Plane<float4>())}) {
    const Texture texture(image, TexelMeaning::Values);
    ASSERT_EQ(texture.view().levels, 1);
    EXPECT_EQ(codes_of(texture.view(), 0), (std::vector<std::uint32_t>{255, 255, 255, 255}));
  }
}

TEST(Texture, ThreadsDoNotMatter) {
  const Rgba8Image image = noise(301, 222, 7);
  const Plane<float4> bright = bright_noise(301, 222);
  std::vector<std::vector<std::uint32_t>> first;
  std::vector<std::vector<float>> first_values;
  for (const int threads : {1, 2, 7}) {
    with_threads(threads, [&] {
      const Texture texture(image, TexelMeaning::Color);
      std::vector<std::vector<std::uint32_t>> levels;
      for (int l = 0; l < texture.view().levels; ++l) levels.push_back(codes_of(texture.view(), l));
      if (first.empty()) first = levels;
      EXPECT_EQ(levels, first);
      const Texture light(bright, TexelMeaning::Color);
      std::vector<std::vector<float>> values;
      for (int l = 0; l < light.view().levels; ++l) values.push_back(values_of(light.view(), l));
      if (first_values.empty()) first_values = values;
      EXPECT_EQ(values, first_values);
    });
  }
}

TEST(Texture, SharperFiltersKeepWavesThatFitAndRemoveOthers) {
  const auto swing = [&](int period, MipFilter filter) {
    Plane<float4> wave(72, 72);
    for (int y = 0; y < 72; ++y)
      for (int x = 0; x < 72; ++x) {
        const float v = 0.5f + 0.4f * std::sin(6.2831853f * static_cast<float>(x) / static_cast<float>(period));
        wave(x, y) = {v, v, v, 1};
      }
    const Texture texture(wave, TexelMeaning::Color, {.filter = filter});
    const TextureView& view = texture.view();
    float low = 1, high = 0;
    for (int x = 0; x < view.width[1]; ++x) {
      const float v = view.values[std::ptrdiff_t{4} * view.texel(1, x, 7)];
      low = std::min(low, v), high = std::max(high, v);
    }
    return high - low;
  };
  for (const MipFilter filter : {MipFilter::Kaiser, MipFilter::Lanczos}) {
    EXPECT_GT(swing(8, filter), 1.05f * swing(8, MipFilter::Box));  // 4 texels of level 1
    EXPECT_LT(swing(3, filter), 0.3f * swing(3, MipFilter::Box));   // 1.5 texels of level 1, beyond its limit
  }

  const Texture even(Rgba8Image(24, 13, Rgba8{99, 5, 250, 17}), TexelMeaning::Values, {.filter = MipFilter::Kaiser});
  for (int l = 0; l < even.view().levels; ++l) {
    const auto codes = codes_of(even.view(), l);
    for (std::size_t i = 0; i < codes.size(); i += 4)
      ASSERT_TRUE(codes[i] == 99 && codes[i + 1] == 5 && codes[i + 2] == 250 && codes[i + 3] == 17) << l;
  }
}

TEST(Texture, KeepsTheCoverageOfAnAlphaTest) {
  Rgba8Image image = noise(64, 64, 7);
  // A fifth of the texels pass, scattered.
  for (Rgba8& p : image.values()) p.a = static_cast<std::uint8_t>(p.a > 200 ? 255 : p.a / 4);
  const auto coverage = [&](const Texture& texture, int level) {
    const TextureView& view = texture.view();
    int passing = 0;
    for (int y = 0; y < view.height[level]; ++y)
      for (int x = 0; x < view.width[level]; ++x)
        if (view.unorm15[std::ptrdiff_t{4} * view.texel(level, x, y) + 3] >= 16384) ++passing;
    return static_cast<double>(passing) / (view.width[level] * view.height[level]);
  };
  const Texture averaged(image, TexelMeaning::Color), kept(image, TexelMeaning::Color, {.kept_cutoff = 0.5f});
  const double wanted = coverage(kept, 0);
  EXPECT_EQ(coverage(averaged, 0), wanted);
  EXPECT_LT(coverage(averaged, 3), 0.3 * wanted);
  for (int l = 1; l < 5; ++l)
    EXPECT_NEAR(coverage(kept, l), wanted, 0.02 + 1.0 / (kept.view().width[l] * kept.view().width[l]));
}

/// An image of every kind, from straight values in [0, 1].
std::vector<TexelImage> images_of(const Plane<float4>& values) {
  Rgba8Image codes(values.width(), values.height());
  Rgba16Image codes16(values.width(), values.height());
  for (std::size_t i = 0; i < values.values().size(); ++i) {
    const float4& v = values.values()[i];
    const auto code = [](float x) { return static_cast<std::uint8_t>(x * 255 + 0.5f); };
    const auto code16 = [](float x) { return static_cast<std::uint16_t>(x * 65535 + 0.5f); };
    codes.values()[i] = {code(v.x), code(v.y), code(v.z), code(v.w)};
    codes16.values()[i] = {code16(v.x), code16(v.y), code16(v.z), code16(v.w)};
  }
  std::vector<TexelImage> out;
  out.emplace_back(std::move(codes)), out.emplace_back(std::move(codes16));
  out.emplace_back(rounded_to_halves(values)), out.emplace_back(values);
  return out;
}

/// All texels of a level, of any kind, in [0, 1].
std::vector<float> units_of(const TextureView& view, int level) {
  if (view.unorm8 == nullptr && view.unorm15 == nullptr) return values_of(view, level);
  std::vector<float> out;
  for (const std::uint32_t code : codes_of(view, level))
    out.push_back(static_cast<float>(code) / (view.unorm8 != nullptr ? 255.0f : 32767.0f));
  return out;
}

// Red leaves of several sizes and opacities on transparency that hides green: no texel of any level is green, so that
// no filter, whatever its weights, can see it.
TEST(Texture, ColoursThatAlphaHidesAreOnNoLevel) {
  for (const auto& [width, height] : {std::pair{32, 16}, {13, 7}, {2, 9}}) {
    Plane<float4> leaves(width, height, float4{0, 1, 0, 0});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (x % 5 == 0 || (y == 3 && x > 20)) leaves(x, y) = {1, 0, 0, x % 2 == 0 ? 1.0f : 0.5f};
    for (const TexelImage& image : images_of(leaves))
      for (const TexelMeaning meaning : {TexelMeaning::Color, TexelMeaning::Values})
        for (const MipFilter filter : {MipFilter::Box, MipFilter::Kaiser, MipFilter::Lanczos})
          for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp}) {
            const Texture texture(image, meaning, {filter, wrap, wrap, {}, true}), plain(image, meaning, {filter});
            float greenest = 0;
            for (int l = 0; l < texture.view().levels; ++l) {
              const std::vector<float> texels = units_of(texture.view(), l), other = units_of(plain.view(), l);
              for (std::size_t i = 0; i < texels.size(); i += 4) {
                ASSERT_EQ(texels[i + 1], 0) << "level " << l << " of " << width;
                ASSERT_NEAR(texels[i], 1, filter == MipFilter::Box ? 0 : 2e-3) << "level " << l;
                greenest = std::max(greenest, other[i + 1]);
                if (wrap == Wrap::Repeat) {
                  ASSERT_EQ(texels[i + 3], other[i + 3]);
                }
              }
            }
            EXPECT_GE(greenest, 1);
            const RipmapView& ripmap = texture.ripmap();
            for (int k = 0; k < ripmap.columns; ++k)
              for (int i = 0; i < ripmap.width[k]; ++i)
                if (ripmap.texels.unorm15 != nullptr) {
                  ASSERT_EQ(ripmap.texels.unorm15[4 * (ripmap.offset[k] + ripmap.width[k] + 3 + i) + 1], 0);
                }
          }
  }
}

TEST(Texture, ColoursAreMeansWeightedByAlpha) {
  Plane<float4> values(2, 2);
  values(0, 0) = {1, 0, 0.2f, 1}, values(1, 0) = {0, 1, 0.5f, 0.5f};  // floats, since halves do not hold 0.2
  values(0, 1) = {0, 0, 1, 0.25f}, values(1, 1) = {1, 1, 1, 0};
  const LevelOptions weighted{.wrap_u = Wrap::Clamp, .wrap_v = Wrap::Clamp, .weights_by_alpha = true};
  const Texture texture(values, TexelMeaning::Values, weighted);
  const std::vector<float> first = values_of(texture.view(), 0), second = values_of(texture.view(), 1);
  const float mean[] = {1 / 1.75f, 0.5f / 1.75f, 0.7f / 1.75f};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_FLOAT_EQ(second[c], mean[c]);
    EXPECT_FLOAT_EQ(first[12 + c], mean[c]);
  }
  EXPECT_EQ(second[3], 0.4375f);
  EXPECT_EQ(std::vector<float>(first.begin() + 4, first.begin() + 8), (std::vector<float>{0, 1, 0.5f, 0.5f}));
  // An opaque image, and the levels of one that is transparent everywhere, are as without weights.
  for (const float alpha : {1.0f, 0.0f}) {
    for (float4& v : values.values()) v.w = alpha;
    const Texture other(values, TexelMeaning::Values, weighted), plain(values, TexelMeaning::Values);
    EXPECT_EQ(values_of(other.view(), 1), values_of(plain.view(), 1));
    if (alpha == 1) {
      EXPECT_EQ(values_of(other.view(), 0), values_of(plain.view(), 0));
    }
  }
}

TEST(Texture, TheSpreadOfNormalsIsThatOfTheTexelsBelow) {
  // Slopes 1 and -1 by columns, 0.5 everywhere along y.
  Plane<float4> map(8, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) {
      const float p = x % 2 == 0 ? 1.0f : -1.0f, q = 0.5f, length = std::sqrt(p * p + q * q + 1);
      map(x, y) = {0.5f + p / length / 2, 0.5f + q / length / 2, 0.5f + 1 / length / 2, 1};
    }
  const Texture texture(map, TexelMeaning::Values);
  const TextureView& spread = texture.normal_spread();
  for (int l = 0; l < spread.levels; ++l)
    for (int y = -1; y <= spread.height[l]; ++y)
      for (int x = -1; x <= spread.width[l]; ++x) {
        const float* const texel = spread.values + std::ptrdiff_t{4} * spread.texel(l, x, y);
        EXPECT_NEAR(texel[0], l == 0 ? 1 : std::sqrt(1.25f / 2.25f), 1e-6) << l;
        EXPECT_NEAR(texel[1], l == 0 ? 0 : 1, 1e-6);
      }
}

}  // namespace
}  // namespace zoneplate
