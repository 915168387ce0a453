// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/bitmap/tga.h"

#include <gtest/gtest.h>

#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/bitmap/pillow_files_for_test.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Parts {
  int kind = 2, bits = 24, descriptor = 0;
  int map_first = 0, map_count = 0, map_bits = 0;
  Bytes map = {}, pixels = {};
  int width = 2, height = 2;
};

/// A file with an identification of two bytes.
Bytes file_of(const Parts& p) {
  const auto low = [](int v) { return static_cast<std::uint8_t>(v & 255); };
  const auto high = [](int v) { return static_cast<std::uint8_t>(v >> 8); };
  Bytes out = {2,
               low(p.map_count > 0 ? 1 : 0),
               low(p.kind),
               low(p.map_first),
               high(p.map_first),
               low(p.map_count),
               high(p.map_count),
               low(p.map_bits),
               0,
               0,
               0,
               0,
               low(p.width),
               high(p.width),
               low(p.height),
               high(p.height),
               low(p.bits),
               low(p.descriptor),
               'i',
               'd'};
  out.insert(out.end(), p.map.begin(), p.map.end());
  out.insert(out.end(), p.pixels.begin(), p.pixels.end());
  return out;
}

Rgba8Image decoded(const Parts& parts) { return decode_tga(file_of(parts), "a.tga", 1000); }

std::string error_of(const Bytes& bytes, std::uint64_t most = 1000) {
  try {
    decode_tga(bytes, "a.tga", most);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "no error";
}

constexpr Rgba8 red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255}, white{255, 255, 255, 255};

/// Red and green above blue and white.
void expect_quarters(const Rgba8Image& image) {
  EXPECT_EQ(image(0, 0), red);
  EXPECT_EQ(image(1, 0), green);
  EXPECT_EQ(image(0, 1), blue);
  EXPECT_EQ(image(1, 1), white);
}

TEST(Tga, EveryOrigin) {
  // Blue, white, red, green: from the bottom left.
  expect_quarters(decoded({.pixels = {255, 0, 0, 255, 255, 255, 0, 0, 255, 0, 255, 0}}));
  expect_quarters(decoded({.descriptor = 0x20, .pixels = {0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255}}));
  expect_quarters(decoded({.descriptor = 0x30, .pixels = {0, 255, 0, 0, 0, 255, 255, 255, 255, 255, 0, 0}}));
  expect_quarters(decoded({.descriptor = 0x10, .pixels = {255, 255, 255, 255, 0, 0, 0, 255, 0, 0, 0, 255}}));
}

TEST(Tga, EveryDepth) {
  expect_quarters(decoded({.bits = 15, .pixels = {0x1f, 0, 0xff, 0x7f, 0, 0x7c, 0xe0, 3}}));
  expect_quarters(decoded({.bits = 16, .pixels = {0x1f, 0, 0xff, 0x7f, 0, 0x7c, 0xe0, 3}}));
  const Rgba8Image half = decoded({.bits = 16, .descriptor = 1, .pixels = {0x1f, 0x80, 0xff, 0x7f, 0, 0x7c, 0xe0, 3}});
  EXPECT_EQ(half(0, 1), blue);
  EXPECT_EQ(half(1, 1), (Rgba8{255, 255, 255, 0}));
  const Rgba8Image full =
      decoded({.bits = 32, .descriptor = 8, .pixels = {1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9}});
  EXPECT_EQ(full(0, 1), (Rgba8{3, 2, 1, 4}));
  // Alpha that hides everything is none.
  expect_quarters(decoded({.bits = 32, .pixels = {255, 0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 0, 0, 255, 0, 0}}));
  const Rgba8Image grey = decoded({.kind = 3, .bits = 8, .pixels = {1, 2, 3, 4}});
  EXPECT_EQ(grey(1, 0), (Rgba8{4, 4, 4, 255}));
  EXPECT_EQ(decoded({.kind = 3, .bits = 16, .descriptor = 8, .pixels = {1, 9, 2, 8, 3, 7, 4, 6}})(1, 0),
            (Rgba8{4, 4, 4, 6}));
}

TEST(Tga, ColorMaps) {
  const Bytes map = {0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255};
  const Parts mapped{
      .kind = 1, .bits = 8, .map_first = 5, .map_count = 4, .map_bits = 24, .map = map, .pixels = {7, 8, 5, 6}};
  expect_quarters(decoded(mapped));
  expect_quarters(decoded({.kind = 1,
                           .bits = 16,
                           .map_count = 4,
                           .map_bits = 16,
                           .map = {0, 0x7c, 0xe0, 3, 0x1f, 0, 0xff, 0x7f},
                           .pixels = {2, 0, 3, 0, 0, 0, 1, 0}}));
  Parts outside = mapped;
  outside.pixels[0] = 4;
  EXPECT_EQ(error_of(file_of(outside)), "a.tga: TGA: names colour 4 of a map from 5 to 8");
  outside.pixels[0] = 9;
  EXPECT_EQ(error_of(file_of(outside)), "a.tga: TGA: names colour 9 of a map from 5 to 8");
}

TEST(Tga, RunLengths) {
  // A packet of a repeated blue pixel, and one of single pixels that goes on in the next row.
  const Rgba8Image image = decoded({.kind = 10, .pixels = {0x80, 255, 0, 0, 2, 255, 255, 255, 0, 0, 255, 0, 255, 0}});
  expect_quarters(image);
  EXPECT_EQ(decoded({.kind = 11, .bits = 8, .pixels = {0x83, 7}}), Rgba8Image(2, 2, {7, 7, 7, 255}));
  EXPECT_EQ(decoded({.kind = 9, .bits = 8, .map_count = 1, .map_bits = 32, .map = {1, 2, 3, 4}, .pixels = {0x83, 0}}),
            Rgba8Image(2, 2, {3, 2, 1, 4}));
  EXPECT_EQ(error_of(file_of({.kind = 11, .bits = 8, .pixels = {0x82, 7}})), "a.tga: TGA: truncated");
  EXPECT_EQ(error_of(file_of({.kind = 11, .bits = 8, .pixels = {3, 1, 2, 3}})), "a.tga: TGA: truncated");
}

TEST(Tga, IsKnownByItsHeader) {
  const Bytes good = file_of({.pixels = Bytes(12)});
  EXPECT_TRUE(is_tga(good));
  EXPECT_EQ(find_tga_size(file_of({.width = 300, .height = 5})), (int2{300, 5}));
  // The kind of map, the kind of image, the size, the depth, reserved bits.
  const std::pair<std::size_t, std::uint8_t> flaws[] = {{1, 2}, {1, 1},  {2, 0},  {2, 4},   {2, 32},
                                                        {2, 1}, {12, 0}, {14, 0}, {16, 12}, {17, 0x40}};
  for (const auto& [at, value] : flaws) {
    Bytes bad = good;
    bad[at] = value;
    EXPECT_FALSE(is_tga(bad)) << at;
    EXPECT_EQ(error_of(bad), "a.tga: not a TGA file");
  }
  for (std::size_t size = 0; size < 20; ++size) EXPECT_FALSE(is_tga(std::span(good).first(size))) << size;
  EXPECT_EQ(error_of(file_of({.pixels = Bytes(11)})), "a.tga: TGA: truncated");
  EXPECT_EQ(error_of(file_of({.width = 40, .height = 26})), "a.tga: TGA: 40 x 26 pixels, at most 1000 are allowed");
}

TEST(Tga, PillowsFiles) {
  for (const PillowFile& file : pillow_tga_files) {
    const Rgba8Image image = decode_tga(file.bytes, file.name, 15);
    for (std::size_t i = 0; i < 15; ++i)
      EXPECT_EQ(image.values()[i],
                (Rgba8{file.pixels[4 * i], file.pixels[4 * i + 1], file.pixels[4 * i + 2], file.pixels[4 * i + 3]}))
          << file.name << " " << i;
  }
}

TEST(Tga, DamageGivesAnImageOrAnError) {
  std::uint32_t variant = 0;
  int images = 0;
  for (const PillowFile& file : pillow_tga_files)
    for (int i = 0; i < 500; ++i) {
      Bytes bad(file.bytes.begin(), file.bytes.end());
      const std::uint32_t changes = 1 + hash(++variant) % 4;
      for (std::uint32_t c = 0; c < changes; ++c)
        bad[hash(variant, c, 1) % bad.size()] = static_cast<std::uint8_t>(hash(variant, c, 2));
      if (i % 3 == 0) bad.resize(hash(variant, 3) % bad.size());
      images += error_of(bad, 1 << 16) == "no error" ? 1 : 0;
    }
  EXPECT_GT(images, 100);
}

}  // namespace
}  // namespace zoneplate
