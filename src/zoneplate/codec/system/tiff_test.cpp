// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/system/tiff.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/codec/system/system_format.h"
#include "zoneplate/codec/system/tiff_file_for_test.h"
#include "zoneplate/image/half.h"
#include "zoneplate/image/orientation.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

template <class T>
Bytes bytes_of(const std::vector<T>& values) {
  Bytes out(values.size() * sizeof(T));
  std::memcpy(out.data(), values.data(), out.size());
  return out;
}
Bytes noise(std::size_t size) {
  Bytes out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(hash(static_cast<std::uint32_t>(i)));
  return out;
}

StoredImage decode(const TiffForTest& t) { return decode_tiff(tiff_of(t), "a.tif", 1 << 20); }
template <class Pixel>
std::vector<Pixel> pixels_of(const StoredImage& image) {
  const auto values = std::get<Plane<Pixel>>(image.pixels).values();
  return {values.begin(), values.end()};
}
std::string tiff_error(const Bytes& file) {
  try {
    decode_tiff(file, "a.tif", 1 << 20);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Tiff, StripsAndTilesOfEveryCompressionAreTheSame) {
  const Bytes codes = noise(3 * 37 * 21);
  Rgba8Image expected(37, 21);
  for (std::size_t i = 0; i < expected.values().size(); ++i)
    expected.values()[i] = {codes[3 * i], codes[3 * i + 1], codes[3 * i + 2], 255};
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS,
                                COMPRESSION_ZSTD, COMPRESSION_LZMA})
    for (const char* mode : {"w", "wb", "w8"})
      for (const auto& [tile, rows] : {std::pair(0, 0), std::pair(0, 4), std::pair(16, 0)}) {
        const TiffForTest t{.width = 37,
                            .height = 21,
                            .compression = static_cast<std::uint16_t>(compression),
                            .tile = tile,
                            .rows_per_strip = rows,
                            .mode = mode,
                            .data = codes};
        EXPECT_EQ(std::get<Rgba8Image>(decode(t).pixels), expected) << compression << " " << mode << " " << tile;
        EXPECT_EQ(find_tiff_size(tiff_of(t))->x, 37);
        EXPECT_EQ(find_tiff_size(tiff_of(t))->y, 21);
      }
}

TEST(Tiff, PlanesMayLieOneAfterTheOther) {
  const Bytes codes = noise(3 * 20 * 19);
  Rgba8Image expected(20, 19);
  constexpr std::size_t plane = 20 * 19;
  for (std::size_t i = 0; i < plane; ++i)
    expected.values()[i] = {codes[i], codes[plane + i], codes[2 * plane + i], 255};
  for (const int tile : {0, 16})
    EXPECT_EQ(std::get<Rgba8Image>(decode({.width = 20,
                                           .height = 19,
                                           .planes = PLANARCONFIG_SEPARATE,
                                           .tile = tile,
                                           .rows_per_strip = 5,
                                           .data = codes})
                                       .pixels),
              expected);
}

TEST(Tiff, JpegIsWithinItsLoss) {
  for (const int photometric : {PHOTOMETRIC_RGB, PHOTOMETRIC_YCBCR}) {
    TiffForTest t{.width = 32,
                  .height = 32,
                  .photometric = static_cast<std::uint16_t>(photometric),
                  .compression = COMPRESSION_JPEG,
                  .data = {}};
    for (int i = 0; i < 32 * 32; ++i) t.data.insert(t.data.end(), {200, 100, 50});
    for (const Rgba8 c : pixels_of<Rgba8>(decode(t))) {
      EXPECT_NEAR(c.r, 200, 3);
      EXPECT_NEAR(c.g, 100, 3);
      EXPECT_NEAR(c.b, 50, 3);
    }
  }
}

TEST(Tiff, GreyHasOneToSixteenBits) {
  EXPECT_EQ(pixels_of<Rgba8>(decode({.width = 9,
                                     .height = 1,
                                     .samples = 1,
                                     .bits = 1,
                                     .photometric = PHOTOMETRIC_MINISBLACK,
                                     .data = {0x81, 0x80}}))[8],
            (Rgba8{255, 255, 255, 255}));
  EXPECT_EQ(pixels_of<Rgba8>(decode({.width = 9,
                                     .height = 1,
                                     .samples = 1,
                                     .bits = 1,
                                     .photometric = PHOTOMETRIC_MINISWHITE,
                                     .data = {0x81, 0x80}})),
            (std::vector<Rgba8>{{0, 0, 0, 255},
                                {255, 255, 255, 255},
                                {255, 255, 255, 255},
                                {255, 255, 255, 255},
                                {255, 255, 255, 255},
                                {255, 255, 255, 255},
                                {255, 255, 255, 255},
                                {0, 0, 0, 255},
                                {0, 0, 0, 255}}));
  EXPECT_EQ(
      pixels_of<Rgba8>(decode(
          {.width = 2, .height = 1, .samples = 1, .bits = 4, .photometric = PHOTOMETRIC_MINISBLACK, .data = {0x3f}})),
      (std::vector<Rgba8>{{51, 51, 51, 255}, {255, 255, 255, 255}}));
  for (const char* mode : {"w", "wb"})
    EXPECT_EQ(pixels_of<Rgba16>(decode({.width = 2,
                                        .height = 1,
                                        .samples = 1,
                                        .bits = 16,
                                        .photometric = PHOTOMETRIC_MINISBLACK,
                                        .mode = mode,
                                        .data = bytes_of<std::uint16_t>({1000, 65535})})),
              (std::vector<Rgba16>{{1000, 1000, 1000, 65535}, {65535, 65535, 65535, 65535}}));
}

TEST(Tiff, PalettesHaveEightBitsOrSixteen) {
  TiffForTest t{.width = 2, .height = 1, .samples = 1, .bits = 2, .photometric = PHOTOMETRIC_PALETTE, .data = {0x60}};
  t.palette = {0, 255 << 8, 7 << 8, 0, 0, 0, 9 << 8, 0, 0, 0, 65535, 0};
  EXPECT_EQ(pixels_of<Rgba8>(decode(t)), (std::vector<Rgba8>{{255, 0, 0, 255}, {7, 9, 255, 255}}));
  t.palette[2] = 1000;
  EXPECT_EQ(pixels_of<Rgba16>(decode(t)), (std::vector<Rgba16>{{255 << 8, 0, 0, 65535}, {1000, 9 << 8, 65535, 65535}}));
  t.palette = {0, 255, 7, 0, 0, 0, 9, 0, 0, 0, 255, 0};  // of a program that stores bytes
  EXPECT_EQ(pixels_of<Rgba8>(decode(t)), (std::vector<Rgba8>{{255, 0, 0, 255}, {7, 9, 255, 255}}));
}

TEST(Tiff, AlphaOfCodesIsStraight) {
  const TiffForTest t{.width = 2, .height = 1, .samples = 4, .data = {100, 50, 0, 128, 0, 0, 0, 0}};
  TiffForTest own = t, associated = t, other = t;
  own.alpha = EXTRASAMPLE_UNASSALPHA, associated.alpha = EXTRASAMPLE_ASSOCALPHA, other.alpha = EXTRASAMPLE_UNSPECIFIED;
  EXPECT_EQ(pixels_of<Rgba8>(decode(own)), (std::vector<Rgba8>{{100, 50, 0, 128}, {0, 0, 0, 0}}));
  EXPECT_EQ(pixels_of<Rgba8>(decode(associated)), (std::vector<Rgba8>{{199, 100, 0, 128}, {0, 0, 0, 0}}));
  EXPECT_EQ(pixels_of<Rgba8>(decode(other)), (std::vector<Rgba8>{{100, 50, 0, 255}, {0, 0, 0, 255}}));
  TiffForTest grey{.width = 1,
                   .height = 1,
                   .samples = 2,
                   .bits = 16,
                   .photometric = PHOTOMETRIC_MINISBLACK,
                   .alpha = EXTRASAMPLE_UNASSALPHA,
                   .data = bytes_of<std::uint16_t>({500, 600})};
  EXPECT_EQ(pixels_of<Rgba16>(decode(grey)), (std::vector<Rgba16>{{500, 500, 500, 600}}));
}

TEST(Tiff, FloatsAreLight) {
  TiffForTest t{.width = 1,
                .height = 1,
                .samples = 4,
                .bits = 32,
                .kind = SAMPLEFORMAT_IEEEFP,
                .alpha = EXTRASAMPLE_ASSOCALPHA,
                .data = bytes_of<float>({-1.5f, 70000, 0.25f, 0.5f})};
  EXPECT_EQ(pixels_of<Linear>(decode(t)), (std::vector<Linear>{{-1.5f, 70000, 0.25f, 0.5f}}));
  t.alpha = EXTRASAMPLE_UNASSALPHA;
  EXPECT_EQ(pixels_of<Linear>(decode(t)), (std::vector<Linear>{{-0.75f, 35000, 0.125f, 0.5f}}));
  t.samples = 3, t.alpha = -1, t.bits = 64, t.data = bytes_of<double>({3, -2, 0.5});
  EXPECT_EQ(pixels_of<Linear>(decode(t)), (std::vector<Linear>{{3, -2, 0.5f, 1}}));
  t.bits = 16, t.data = bytes_of<std::uint16_t>({0x3c00, 0xc000, 0x7bff});
  EXPECT_EQ(pixels_of<Linear>(decode(t)), (std::vector<Linear>{{1, -2, 65504, 1}}));
}

TEST(Tiff, TheOrientationIsStated) {
  // 2 x 3 pixels whose red is their number.
  for (int orientation = 1; orientation <= 8; ++orientation) {
    TiffForTest t{.width = 2,
                  .height = 3,
                  .samples = 1,
                  .photometric = PHOTOMETRIC_MINISBLACK,
                  .orientation = static_cast<std::uint16_t>(orientation),
                  .data = {0, 1, 2, 3, 4, 5}};
    const StoredImage image = decode(t);
    EXPECT_EQ(image.orientation, orientation);
    const Rgba8Image shown = oriented(std::get<Rgba8Image>(image.pixels), orientation);
    const std::vector<std::vector<int>> expected = {{0, 1, 2, 3, 4, 5}, {1, 0, 3, 2, 5, 4}, {5, 4, 3, 2, 1, 0},
                                                    {4, 5, 2, 3, 0, 1}, {0, 2, 4, 1, 3, 5}, {4, 2, 0, 5, 3, 1},
                                                    {5, 3, 1, 4, 2, 0}, {1, 3, 5, 0, 2, 4}};
    EXPECT_EQ(shown.width(), orientation < 5 ? 2 : 3);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_EQ(shown.values()[i].r, expected[static_cast<std::size_t>(orientation) - 1][i]) << orientation << " " << i;
  }
}

TEST(Tiff, TheProfileIsFound) {
  const Bytes profile = noise(50);
  for (const char* mode : {"w", "wb", "w8"}) {
    const Bytes file = tiff_of({.width = 1, .height = 1, .mode = mode, .profile = profile, .data = {1, 2, 3}});
    EXPECT_TRUE(std::ranges::equal(find_tiff_colors(file).profile, profile)) << mode;
    EXPECT_TRUE(color_space_of(file).starts_with("ICC profile of 50 bytes")) << color_space_of(file);
  }
  EXPECT_EQ(color_space_of(tiff_of({.width = 1, .height = 1, .data = {1, 2, 3}})), "");
}

TEST(Tiff, OtherKindsAreNamed) {
  const auto refusal = [](std::uint16_t photometric, std::uint16_t samples) {
    return tiff_error(
        tiff_of({.width = 1, .height = 1, .samples = samples, .photometric = photometric, .data = {0, 0, 0, 0}}));
  };
  EXPECT_EQ(refusal(PHOTOMETRIC_SEPARATED, 4),
            "a.tif: TIFF: its image is of inks (CMYK), expected grey, RGB or a palette");
  EXPECT_EQ(refusal(PHOTOMETRIC_CIELAB, 3), "a.tif: TIFF: its image is in CIE L*a*b*, expected grey, RGB or a palette");
  EXPECT_EQ(
      tiff_error(tiff_of({.width = 1, .height = 1, .bits = 32, .data = Bytes(12)})),
      "a.tif: TIFF: 32 bits per channel, expected codes of 8 or 16 bits, of 1, 2 or 4 without colours, or floats");
  EXPECT_EQ(
      tiff_error(tiff_of({.width = 1, .height = 1, .kind = SAMPLEFORMAT_INT, .data = Bytes(3)})),
      "a.tif: TIFF: 8 bits per channel of signed or complex numbers, expected codes of 8 or 16 bits, of 1, 2 or 4 "
      "without colours, or floats");
}

TEST(Tiff, LiesAboutSizesAndDamageAreErrors) {
  Bytes file =
      tiff_of({.width = 5, .height = 4, .compression = COMPRESSION_LZW, .rows_per_strip = 2, .data = noise(60)});
  EXPECT_EQ(tiff_error(file), "");
  for (std::size_t size = 0; size < file.size(); size += 3)
    EXPECT_NE(tiff_error({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
  for (std::uint32_t i = 0; i < 400; ++i) {
    Bytes changed = file;
    changed[4 + hash(i) % (changed.size() - 4)] = static_cast<std::uint8_t>(hash(i + 1000));
    EXPECT_EQ(tiff_error(changed).find('\n'), std::string::npos) << i;
  }
  const Bytes wide = tiff_of({.width = 5, .height = 4, .mode = "wb", .data = noise(60)});
  for (std::size_t i = 0; i + 12 < wide.size(); ++i) {
    constexpr std::uint8_t width_entry[] = {1, 0, 0, 3, 0, 0, 0, 1};
    if (!std::equal(std::begin(width_entry), std::end(width_entry), wide.begin() + static_cast<std::ptrdiff_t>(i)))
      continue;
    Bytes lie = wide;
    lie[i + 3] = 4, lie[i + 8] = 0x7f;  // 2130706432 + 5 * 65536 columns
    EXPECT_TRUE(tiff_error(lie).ends_with("x 4 pixels, at most 1048576 are allowed")) << tiff_error(lie);
  }
}

}  // namespace
}  // namespace zoneplate
