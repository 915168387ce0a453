// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/bitmap/bmp.h"

#include <gtest/gtest.h>

#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/bitmap/pillow_files_for_test.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put(Bytes& out, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) out.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

struct Parts {
  int width = 2, height = 2;
  std::uint32_t bits = 24, compression = 0, colors = 0, header = 40;
  std::vector<std::uint32_t> masks = {};  ///< of 40 bytes they follow the header
  Bytes palette = {}, pixels = {};
};

Bytes file_of(const Parts& p) {
  Bytes out = {'B', 'M', 0, 0, 0, 0, 0, 0, 0, 0};
  const std::size_t masks = p.header == 40 ? 4 * p.masks.size() : 0;
  put(out, static_cast<std::uint32_t>(14 + p.header + masks + p.palette.size()), 4);
  put(out, p.header, 4);
  const int size = p.header == 12 ? 2 : 4;
  put(out, static_cast<std::uint32_t>(p.width), size), put(out, static_cast<std::uint32_t>(p.height), size);
  put(out, 1, 2), put(out, p.bits, 2);
  if (p.header > 12)
    put(out, p.compression, 4), put(out, 0, 4), put(out, 0, 4), put(out, 0, 4), put(out, p.colors, 4), put(out, 0, 4);
  for (const std::uint32_t mask : p.masks) put(out, mask, 4);
  out.resize(14 + p.header + masks);
  out.insert(out.end(), p.palette.begin(), p.palette.end());
  out.insert(out.end(), p.pixels.begin(), p.pixels.end());
  return out;
}

Rgba8Image decoded(const Parts& parts) { return decode_bmp(file_of(parts), "a.bmp", 1000); }

std::string error_of(const Bytes& bytes, std::uint64_t most = 1000) {
  try {
    decode_bmp(bytes, "a.bmp", most);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "no error";
}

constexpr Rgba8 red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255}, white{255, 255, 255, 255};
const Bytes four_colors = {0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0, 0, 255, 255, 255, 0};

/// Red and green above blue and white.
void expect_quarters(const Rgba8Image& image) {
  ASSERT_EQ(image.width(), 2);
  ASSERT_EQ(image.height(), 2);
  EXPECT_EQ(image(0, 0), red);
  EXPECT_EQ(image(1, 0), green);
  EXPECT_EQ(image(0, 1), blue);
  EXPECT_EQ(image(1, 1), white);
}

TEST(Bmp, EveryDepth) {
  expect_quarters(decoded({.pixels = {255, 0, 0, 255, 255, 255, 0, 0, 0, 0, 255, 0, 255, 0, 0, 0}}));
  expect_quarters(decoded({.bits = 32, .pixels = {255, 0, 0, 0, 255, 255, 255, 0, 0, 0, 255, 0, 0, 255, 0, 0}}));
  expect_quarters(decoded({.bits = 16, .pixels = {0x1f, 0, 0xff, 0x7f, 0, 0x7c, 0xe0, 3}}));
  expect_quarters(decoded({.bits = 8, .colors = 4, .palette = four_colors, .pixels = {2, 3, 0, 0, 0, 1, 0, 0}}));
  expect_quarters(decoded({.bits = 4, .colors = 4, .palette = four_colors, .pixels = {0x23, 0, 0, 0, 0x01, 0, 0, 0}}));
  const Parts one{.width = 9,
                  .height = 1,
                  .bits = 1,
                  .colors = 2,
                  .palette = {0, 0, 255, 0, 0, 255, 0, 0},
                  .pixels = {0x40, 0x80, 0, 0}};
  for (int x = 0; x < 9; ++x) EXPECT_EQ(decoded(one)(x, 0), x == 1 || x == 8 ? green : red) << x;
}

TEST(Bmp, RowsFromTheTopAndOldHeaders) {
  const Bytes down = {0, 0, 255, 0, 255, 0, 0, 0, 255, 0, 0, 255, 255, 255, 0, 0};
  expect_quarters(decoded({.height = -2, .pixels = down}));
  const Bytes up = {255, 0, 0, 255, 255, 255, 0, 0, 0, 0, 255, 0, 255, 0};  // the last row may lack its padding
  expect_quarters(decoded({.header = 12, .pixels = up}));
  const Bytes palette = {0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255};
  expect_quarters(decoded({.bits = 8, .header = 12, .palette = palette, .pixels = {2, 3, 0, 0, 0, 1, 0, 0}}));
}

TEST(Bmp, BitFields) {
  expect_quarters(decoded({.bits = 16,
                           .compression = 3,
                           .masks = {0xf800, 0x07e0, 0x001f},
                           .pixels = {0x1f, 0, 0xff, 0xff, 0, 0xf8, 0xe0, 7}}));
  const std::vector<std::uint32_t> masks = {0xff, 0xff00, 0xff0000, 0xff000000};
  const Bytes pixels = {1, 2, 3, 4, 5, 6, 7, 8};
  for (const std::uint32_t header : {40u, 56u, 108u, 124u}) {
    const Rgba8Image image = decoded({.height = 1,
                                      .bits = 32,
                                      .compression = header == 40 ? 6u : 3u,
                                      .header = header,
                                      .masks = masks,
                                      .pixels = pixels});
    EXPECT_EQ(image(0, 0), (Rgba8{1, 2, 3, 4})) << header;
    EXPECT_EQ(image(1, 0), (Rgba8{5, 6, 7, 8})) << header;
  }
  // Ten bits, and no alpha.
  const Rgba8Image deep = decoded({.width = 1,
                                   .height = 1,
                                   .bits = 32,
                                   .compression = 3,
                                   .masks = {0x3ff00000, 0xffc00, 0x3ff},
                                   .pixels = {0, 0xfc, 0x0f, 0x20}});
  EXPECT_EQ(deep(0, 0), (Rgba8{128, 255, 0, 255}));
  EXPECT_EQ(error_of(file_of({.bits = 32, .compression = 3, .masks = {5, 2, 8}, .pixels = Bytes(16)})),
            "a.bmp: BMP: a bit field has gaps");
}

TEST(Bmp, RunLengths) {
  const Parts eight{.bits = 8,
                    .compression = 1,
                    .colors = 4,
                    .palette = four_colors,
                    .pixels = {1, 2, 1, 3, 0, 0, 0, 2, 0, 0, 0, 3, 0, 1, 9, 0, 0, 1}};
  // A run of one blue and one white; then nothing, and three single pixels, of which one is outside.
  expect_quarters(decoded(eight));
  const Parts four{.bits = 4,
                   .compression = 2,
                   .colors = 4,
                   .palette = four_colors,
                   .pixels = {2, 0x23, 0, 0, 0, 3, 0x01, 0x20, 0, 1}};
  expect_quarters(decoded(four));
  // A step of one to the right and one up: what is left out has the first colour.
  const Rgba8Image step =
      decoded({.bits = 8, .compression = 1, .colors = 4, .palette = four_colors, .pixels = {0, 2, 1, 1, 1, 1, 0, 1}});
  EXPECT_EQ(step(1, 0), green);
  for (const Rgba8 c : {step(0, 0), step(0, 1), step(1, 1)}) EXPECT_EQ(c, red);
  // Without the mark of its end the image is whole after its last pixel, and truncated before.
  const Bytes all = {2, 1, 0, 0, 2, 1};
  Parts endless{.bits = 8, .compression = 1, .colors = 4, .palette = four_colors, .pixels = all};
  EXPECT_EQ(decoded(endless), Rgba8Image(2, 2, green));
  // Whatever follows that pixel is not a run: padding, a colour profile, what would be a truncated run.
  for (const Bytes& more : {Bytes{0}, Bytes{0, 0, 0, 3}, Bytes{0, 0, 9}, Bytes{'I', 'C', 'C'}}) {
    endless.pixels = all;
    endless.pixels.insert(endless.pixels.end(), more.begin(), more.end());
    EXPECT_EQ(decoded(endless), Rgba8Image(2, 2, green));
  }
  endless.pixels = all;
  endless.pixels.resize(4);
  EXPECT_EQ(error_of(file_of(endless)), "a.bmp: BMP: truncated");
}

TEST(Bmp, SaysWhatIsWrong) {
  EXPECT_EQ(error_of({}), "a.bmp: not a BMP file");
  EXPECT_EQ(error_of({'B', 'M'}), "a.bmp: BMP: its header is truncated or invalid");
  EXPECT_EQ(error_of(file_of({.width = 0})), "a.bmp: BMP: its header is truncated or invalid");
  EXPECT_EQ(error_of(file_of({.width = 40, .height = 26})), "a.bmp: BMP: 40 x 26 pixels, at most 1000 are allowed");
  EXPECT_EQ(error_of(file_of({.bits = 2})), "a.bmp: BMP: 2 bits per pixel, expected 1, 4, 8, 16, 24 or 32");
  EXPECT_EQ(error_of(file_of({.compression = 4})), "a.bmp: BMP: compression 4 of 24 bits per pixel is not supported");
  EXPECT_EQ(error_of(file_of({.pixels = Bytes(13)})), "a.bmp: BMP: truncated");
  EXPECT_EQ(error_of(file_of({.bits = 8, .palette = four_colors, .pixels = Bytes(8, 4)})),
            "a.bmp: BMP: names colour 4 of a palette of 4");
  EXPECT_EQ(error_of(file_of({.bits = 8, .pixels = Bytes(8)})), "a.bmp: BMP: has no palette");
  EXPECT_FALSE(find_bmp_size(file_of({.height = std::numeric_limits<int>::min()})));
  EXPECT_EQ(find_bmp_size(file_of({.width = 70000, .height = -5})), (int2{70000, 5}));
}

TEST(Bmp, PillowsFiles) {
  for (const PillowFile& file : pillow_bmp_files) {
    const Rgba8Image image = decode_bmp(file.bytes, file.name, 15);
    for (std::size_t i = 0; i < 15; ++i)
      EXPECT_EQ(image.values()[i],
                (Rgba8{file.pixels[4 * i], file.pixels[4 * i + 1], file.pixels[4 * i + 2], file.pixels[4 * i + 3]}))
          << file.name << " " << i;
  }
}

TEST(Bmp, DamageGivesAnImageOrAnError) {
  std::uint32_t variant = 0;
  int images = 0;
  for (const PillowFile& file : pillow_bmp_files)
    for (int i = 0; i < 1000; ++i) {
      Bytes bad(file.bytes.begin(), file.bytes.end());
      const std::uint32_t changes = 1 + hash(++variant) % 4;
      for (std::uint32_t c = 0; c < changes; ++c)
        bad[2 + hash(variant, c, 1) % (bad.size() - 2)] = static_cast<std::uint8_t>(hash(variant, c, 2) % 40);
      if (i % 3 == 0) bad.resize(hash(variant, 3) % bad.size());
      images += error_of(bad, 1 << 16) == "no error" ? 1 : 0;
    }
  EXPECT_GT(images, 100);
}

}  // namespace
}  // namespace zoneplate
