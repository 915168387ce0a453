// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/png.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/codec/png/png_chunk.h"
#include "zoneplate/math/random.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

enum ColorType { Grey = 0, Rgb = 2, Indexed = 3, GreyAlpha = 4, RgbAlpha = 6 };

int channels_of(ColorType type) { return type == Rgb ? 3 : type == GreyAlpha ? 2 : type == RgbAlpha ? 4 : 1; }

/// An image of noise and its encoder, which uses zlib but not libpng.
struct Noise {
  int width, height, bit_depth;
  ColorType type;
  bool is_interlaced = false;
  bool has_transparency = false;

  std::uint32_t greatest() const { return (1u << bit_depth) - 1; }
  std::uint32_t sample(int x, int y, int channel) const {
    return hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(channel)) &
           greatest();
  }
  static Rgba8 palette(std::uint32_t index) {
    return {static_cast<std::uint8_t>(index * 7), static_cast<std::uint8_t>(255 - index),
            static_cast<std::uint8_t>(index ^ 0x55), 255};
  }
};

void append(Bytes& bytes, std::uint32_t word) {
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(word >> shift));
}

void append_chunk(Bytes& png, std::string_view name, const Bytes& data) {
  append(png, static_cast<std::uint32_t>(data.size()));
  Bytes body(name.begin(), name.end());
  body.insert(body.end(), data.begin(), data.end());
  png.insert(png.end(), body.begin(), body.end());
  append(png, static_cast<std::uint32_t>(crc32(0, body.data(), static_cast<uInt>(body.size()))));
}

/// Appends the rows of one interlace pass: each with filter type 0, samples packed from the most significant bit.
void append_pass(Bytes& raw, const Noise& noise, int x0, int y0, int dx, int dy) {
  if (x0 >= noise.width) return;
  for (int y = y0; y < noise.height; y += dy) {
    raw.push_back(0);
    std::uint32_t held = 0;
    int bits = 0;
    const auto put = [&](std::uint32_t value, int count) {
      held = held << count | value;
      for (bits += count; bits >= 8; bits -= 8) raw.push_back(static_cast<std::uint8_t>(held >> (bits - 8)));
    };
    for (int x = x0; x < noise.width; x += dx) {
      for (int c = 0; c < channels_of(noise.type); ++c) put(noise.sample(x, y, c), noise.bit_depth);
    }
    if (bits > 0) put(0, 8 - bits);
  }
}

Bytes deflated(const Bytes& raw) {
  Bytes packed(compressBound(raw.size()));
  uLongf size = packed.size();
  compress2(packed.data(), &size, raw.data(), raw.size(), 6);
  packed.resize(size);
  return packed;
}

Bytes png_of(const Noise& noise) {
  Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  Bytes header;
  append(header, static_cast<std::uint32_t>(noise.width));
  append(header, static_cast<std::uint32_t>(noise.height));
  for (const int value : {noise.bit_depth, static_cast<int>(noise.type), 0, 0, noise.is_interlaced ? 1 : 0}) {
    header.push_back(static_cast<std::uint8_t>(value));
  }
  append_chunk(png, "IHDR", header);
  if (noise.type == Indexed) {
    Bytes colors;
    for (std::uint32_t i = 0; i <= noise.greatest(); ++i) {
      const Rgba8 c = Noise::palette(i);
      colors.insert(colors.end(), {c.r, c.g, c.b});
    }
    append_chunk(png, "PLTE", colors);
  }
  if (noise.has_transparency) {
    Bytes keys;
    if (noise.type == Indexed) {
      keys = {0, 128};
    } else {
      for (int c = 0; c < channels_of(noise.type); ++c) {
        keys.push_back(static_cast<std::uint8_t>(noise.sample(0, 0, c) >> 8));
        keys.push_back(static_cast<std::uint8_t>(noise.sample(0, 0, c)));
      }
    }
    append_chunk(png, "tRNS", keys);
  }
  Bytes raw;
  if (noise.is_interlaced) {
    constexpr int adam7[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                 {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    for (const auto& pass : adam7) append_pass(raw, noise, pass[0], pass[1], pass[2], pass[3]);
  } else {
    append_pass(raw, noise, 0, 0, 1, 1);
  }
  append_chunk(png, "IDAT", deflated(raw));
  append_chunk(png, "IEND", {});
  return png;
}

/// The decoded pixel of the noise, with 16 bits per channel.
Rgba16 wanted_pixel(const Noise& noise, int x, int y) {
  const auto widened = [&](int channel) {
    return static_cast<std::uint16_t>(noise.sample(x, y, channel) * 65535u / noise.greatest());
  };
  if (noise.type == Indexed) {
    const std::uint32_t index = noise.sample(x, y, 0);
    const Rgba8 c = Noise::palette(index);
    const int alpha = !noise.has_transparency || index > 1 ? 255 : index == 0 ? 0 : 128;
    const auto up = [](int code) { return static_cast<std::uint16_t>(code * 257); };
    return {up(c.r), up(c.g), up(c.b), up(alpha)};
  }
  const bool is_color = noise.type == Rgb || noise.type == RgbAlpha;
  const int count = channels_of(noise.type);
  Rgba16 pixel{widened(0), widened(is_color ? 1 : 0), widened(is_color ? 2 : 0), 65535};
  if (noise.type == GreyAlpha || noise.type == RgbAlpha) pixel.a = widened(count - 1);
  if (noise.has_transparency) {
    bool is_key = true;
    for (int c = 0; c < count; ++c) is_key = is_key && noise.sample(x, y, c) == noise.sample(0, 0, c);
    if (is_key) pixel.a = 0;
  }
  return pixel;
}

void expect_decodes(const Noise& noise) {
  const PngImage image = decode_png(png_of(noise), "noise.png");
  ASSERT_EQ(image.pixels.width(), noise.width);
  ASSERT_EQ(image.pixels.height(), noise.height);
  ASSERT_EQ(image.pixels16.empty(), noise.bit_depth != 16);
  for (int y = 0; y < noise.height; ++y) {
    for (int x = 0; x < noise.width; ++x) {
      const Rgba16 expected = wanted_pixel(noise, x, y);
      const auto rounded = [](int code) { return static_cast<std::uint8_t>((2 * code + 257) / 514); };
      const Rgba8 expected8{rounded(expected.r), rounded(expected.g), rounded(expected.b), rounded(expected.a)};
      ASSERT_EQ(image.pixels(x, y), expected8) << "type " << noise.type << ", " << noise.bit_depth << " bits";
      if (noise.bit_depth == 16) {
        ASSERT_EQ(image.pixels16(x, y), expected);
      }
    }
  }
}

TEST(Png, DecodesEveryKind) {
  const std::vector<std::pair<ColorType, std::vector<int>>> kinds = {
      {Grey, {1, 2, 4, 8, 16}}, {Rgb, {8, 16}}, {Indexed, {1, 2, 4, 8}}, {GreyAlpha, {8, 16}}, {RgbAlpha, {8, 16}}};
  for (const auto& [type, depths] : kinds) {
    for (const int bit_depth : depths) {
      for (const bool is_interlaced : {false, true}) {
        for (const bool has_transparency : {false, true}) {
          if (has_transparency && (type == GreyAlpha || type == RgbAlpha)) continue;
          for (const auto& [width, height] : {std::pair{1, 1}, std::pair{2, 9}, std::pair{13, 7}, std::pair{33, 18}}) {
            expect_decodes({width, height, bit_depth, type, is_interlaced, has_transparency});
          }
        }
      }
    }
  }
}

Rgba8Image noise8(int width, int height) {
  Rgba8Image image(width, height);
  std::uint32_t i = 0;
  for (Rgba8& c : image.values()) {
    const std::uint32_t w = hash(i++ / 3);
    c = {static_cast<std::uint8_t>(w), static_cast<std::uint8_t>(w >> 8), static_cast<std::uint8_t>(w >> 16),
         static_cast<std::uint8_t>(w >> 24)};
  }
  return image;
}

Rgba16Image noise16(int width, int height) {
  Rgba16Image image(width, height);
  std::uint32_t i = 0;
  for (Rgba16& c : image.values()) {
    const std::uint32_t v = hash(i, 1), w = hash(i++, 2);
    c = {static_cast<std::uint16_t>(v), static_cast<std::uint16_t>(v >> 16), static_cast<std::uint16_t>(w),
         static_cast<std::uint16_t>(w >> 16)};
  }
  return image;
}

TEST(Png, EncodesAndDecodesTheSamePixels) {
  for (const bool is_small : {false, true}) {
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{37, 23}, std::pair{200, 300}}) {
      Rgba8Image image = noise8(width, height);
      EXPECT_EQ(decode_png(encode_png(image, {.is_small = is_small}), "a").pixels, image);
      const Rgba8Image opaque = decode_png(encode_png(image, {.has_alpha = false, .is_small = is_small}), "a").pixels;
      for (Rgba8& c : image.values()) c.a = 255;
      EXPECT_EQ(opaque, image);

      Rgba16Image deep = noise16(width, height);
      EXPECT_EQ(decode_png(encode_png(deep, {.is_small = is_small}), "a").pixels16, deep);
      const Rgba16Image deep_opaque =
          decode_png(encode_png(deep, {.has_alpha = false, .is_small = is_small}), "a").pixels16;
      for (Rgba16& c : deep.values()) c.a = 65535;
      EXPECT_EQ(deep_opaque, deep);

      Plane<std::uint16_t> grey(width, height);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x)
          grey(x, y) = static_cast<std::uint16_t>(hash(3, static_cast<std::uint32_t>(x + y)));
      }
      const Rgba16Image grey_back = decode_png(encode_png(grey, {.is_small = is_small}), "a").pixels16;
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const std::uint16_t v = grey(x, y);
          ASSERT_EQ(grey_back(x, y), (Rgba16{v, v, v, 65535}));
        }
      }
    }
  }
}

/// The names of the chunks in order, and the data of the last one called `chosen`.
std::pair<std::string, std::string> chunks_of(const Bytes& png, std::string_view chosen) {
  std::string names, data;
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t size = (std::size_t{png[at]} << 24) | (std::size_t{png[at + 1]} << 16) |
                             (std::size_t{png[at + 2]} << 8) | std::size_t{png[at + 3]};
    const std::string name(png.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                           png.begin() + static_cast<std::ptrdiff_t>(at) + 8);
    names += name + " ";
    if (name == chosen) {
      data.assign(png.begin() + static_cast<std::ptrdiff_t>(at) + 8,
                  png.begin() + static_cast<std::ptrdiff_t>(at + 8 + size));
    }
    at += size + 12;
  }
  return {names, data};
}

TEST(Png, NumbersTheColoursOfAPictureThatHasFew) {
  for (const int colors : {1, 2, 255, 256, 257}) {
    Rgba8Image image(40, 30);
    for (int i = 0; i < 1200; ++i) {
      const int c = i * 7 % colors;
      image(i % 40, i / 40) = {static_cast<std::uint8_t>(c), static_cast<std::uint8_t>(c / 256), 9, 255};
    }
    const auto file = encode_png(image, {.has_alpha = false, .is_small = true, .may_be_indexed = true});
    EXPECT_EQ(decode_png(file, "a").pixels, image);
    EXPECT_EQ(file[25], colors <= 256 ? 3 : 2) << colors;  // the header's colour type: indexed, RGB
    EXPECT_EQ(encode_png(image, {.may_be_indexed = true})[25], 6);
  }
}

TEST(Png, WritesOnlyTheChunksAskedFor) {
  const Rgba8Image image = noise8(4, 4);
  EXPECT_EQ(chunks_of(encode_png(image), "").first, "IHDR sRGB IDAT IEND ");
  EXPECT_EQ(chunks_of(encode_png(image, {.is_srgb = false}), "").first, "IHDR IDAT IEND ");
  const auto [names, text] = chunks_of(encode_png(image, {.text = {{"Software", "Zoneplate"}}}), "tEXt");
  EXPECT_EQ(names, "IHDR sRGB tEXt IDAT IEND ");
  EXPECT_EQ(text, std::string("Software\0Zoneplate", 18));
  EXPECT_EQ(chunks_of(encode_png(image, {.text = {{"Title", "h\xc3\xa9"}}}), "iTXt").second,
            std::string("Title\0\0\0\0\0h\xc3\xa9", 13));
  EXPECT_EQ(encode_png(image), encode_png(image));
}

std::string error_of(const Bytes& bytes, std::uint64_t max_pixels = std::uint64_t{1} << 28) {
  try {
    decode_png(bytes, "a.png", max_pixels);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "";
}

TEST(Png, SaysWhatIsWrong) {
  const Bytes good = png_of({33, 18, 8, Rgb});
  EXPECT_EQ(error_of(good), "");
  EXPECT_EQ(error_of({}), "a.png: not a PNG file");
  EXPECT_EQ(error_of({'G', 'I', 'F', '8', '9', 'a', 0, 0, 0}), "a.png: not a PNG file");
  EXPECT_EQ(error_of(good, 33 * 18), "");
  EXPECT_EQ(error_of(good, 33 * 18 - 1), "a.png: PNG: 33 x 18 pixels, at most 593 are allowed");
  for (std::size_t size = 8; size < good.size(); ++size) {
    EXPECT_EQ(error_of(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))),
              "a.png: PNG: the file is truncated");
  }
}

TEST(Png, RefusesEveryFlippedBit) {
  // Every bit of a file without ancillary chunks belongs to the signature, to data with a checksum, or to a length.
  const Bytes good = png_of({5, 4, 8, Rgb});
  for (std::size_t i = 0; i < good.size() * 8; ++i) {
    Bytes bad = good;
    bad[i / 8] = static_cast<std::uint8_t>(bad[i / 8] ^ (1 << (i % 8)));
    // A damaged name may make a chunk ancillary, which is skipped; the image data is then missing.
    EXPECT_NE(error_of(bad), "") << "bit " << i;
  }
}

TEST(Png, ClaimsWithoutDataCostNothing) {
  Bytes header;
  append(header, 16000);
  append(header, 16000);
  header.insert(header.end(), {8, RgbAlpha, 0, 0, 0});
  Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", deflated(Bytes(100)));
  append_chunk(png, "IEND", {});
  EXPECT_EQ(error_of(png), "a.png: PNG: the file is truncated");
}

/// Corrects the checksums of the remaining chunks, so that damage reaches the decoder behind them.
void mend_checksums(Bytes& png) {
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t size = (std::size_t{png[at]} << 24) | (std::size_t{png[at + 1]} << 16) |
                             (std::size_t{png[at + 2]} << 8) | std::size_t{png[at + 3]};
    if (size > png.size() - at - 12) return;
    Bytes sum;
    append(sum, static_cast<std::uint32_t>(crc32(0, png.data() + at + 4, static_cast<uInt>(size + 4))));
    std::copy(sum.begin(), sum.end(), png.begin() + static_cast<std::ptrdiff_t>(at + 8 + size));
    at += size + 12;
  }
}

TEST(Png, DamageGivesAPictureOrAnError) {
  const Noise kinds[] = {
      {13, 7, 8, Rgb, true}, {13, 7, 4, Indexed, false, true}, {13, 7, 16, RgbAlpha}, {9, 9, 1, Grey, true}};
  std::uint32_t variant = 0;
  int pictures = 0;
  for (const Noise& noise : kinds) {
    const Bytes good = png_of(noise);
    for (int i = 0; i < 1500; ++i) {
      Bytes bad = good;
      const std::uint32_t changes = 1 + hash(++variant) % 4;
      for (std::uint32_t c = 0; c < changes; ++c) {
        const std::size_t at = 8 + hash(variant, c, 1) % (bad.size() - 8);
        bad[at] = static_cast<std::uint8_t>(hash(variant, c, 2));
      }
      if (i % 3 == 0) bad.resize(8 + hash(variant, 3) % (bad.size() - 8));
      if (i % 2 == 0) mend_checksums(bad);
      pictures += error_of(bad, 1 << 20).empty() ? 1 : 0;
    }
  }
  EXPECT_GT(pictures, 0);
}

class SharedPng : public testing::TestWithParam<std::string> {};
TEST_P(SharedPng, IsDecodedUnlessItIsInvalid) {
  const FileBytes file(GetParam());
  const std::string error = error_of(Bytes(file.bytes().begin(), file.bytes().end()));
  EXPECT_EQ(error.empty(), GetParam().find("/invalid/") == std::string::npos) << error;
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedPng);
INSTANTIATE_TEST_SUITE_P(Images, SharedPng, testing::ValuesIn(shared_files_ending("data/images", {".png"})));
INSTANTIATE_TEST_SUITE_P(Invalid, SharedPng, testing::ValuesIn(shared_files_ending("data/invalid", {".png"})));

TEST(PngChunk, EndsInTheChecksumOfNameAndData) {
  // The IEND chunk of the specification, and the check value of the CRC ("123456789" gives cbf43926).
  Bytes out{1};
  put_png_chunk(out, "IEND", {});
  EXPECT_EQ(out, (Bytes{1, 0, 0, 0, 0, 'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82}));
  const Bytes digits{'5', '6', '7', '8', '9'};
  out.clear();
  put_png_chunk(out, "1234", digits);
  EXPECT_EQ(out, (Bytes{0, 0, 0, 5, '1', '2', '3', '4', '5', '6', '7', '8', '9', 0xcb, 0xf4, 0x39, 0x26}));
  Bytes known;
  put_png_chunk(known, "1234", digits, 0xcbf43926);
  EXPECT_EQ(known, out);
  EXPECT_EQ(png_checksum(7, {}), 7u);
}

}  // namespace
}  // namespace zoneplate
