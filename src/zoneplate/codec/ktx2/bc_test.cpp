// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/bc.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/ktx2/ktx2.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using ktx2::BlockFormat;
using Bytes = std::vector<std::uint8_t>;

std::array<Rgba8, 16> decoded(BlockFormat format, const Bytes& block) {
  const std::string name = "tex";
  EXPECT_EQ(block.size(), ktx2::block_bytes(format));
  return ktx2::decode_block(format, block, {name});
}

TEST(BlockFormats, ColoursAreMeansOfTwo) {
  // Red 31 and blue 31; the indices of the first row are 0, 1, 2, 3.
  const Bytes red_first = {0x00, 0xf8, 0x1f, 0x00, 0xe4, 0, 0, 0}, blue_first = {0x1f, 0x00, 0x00, 0xf8, 0xe4, 0, 0, 0};
  const auto four = decoded(BlockFormat::Bc1, red_first);
  EXPECT_EQ(four[0], (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(four[1], (Rgba8{0, 0, 255, 255}));
  EXPECT_EQ(four[2], (Rgba8{170, 0, 85, 255}));
  EXPECT_EQ(four[3], (Rgba8{85, 0, 170, 255}));
  EXPECT_EQ(four[4], (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(decoded(BlockFormat::Bc1, blue_first)[2], (Rgba8{128, 0, 128, 255}));
  EXPECT_EQ(decoded(BlockFormat::Bc1, blue_first)[3], (Rgba8{0, 0, 0, 255}));
  EXPECT_EQ(decoded(BlockFormat::Bc1Alpha, blue_first)[3], (Rgba8{0, 0, 0, 0}));
  Bytes with_alpha = {0x10, 0x32, 0, 0, 0, 0, 0, 0xf0};
  with_alpha.insert(with_alpha.end(), blue_first.begin(), blue_first.end());
  const auto sharp = decoded(BlockFormat::Bc2, with_alpha);
  EXPECT_EQ(sharp[0], (Rgba8{0, 0, 255, 0}));
  EXPECT_EQ(sharp[3], (Rgba8{170, 0, 85, 51}));  // always four levels of colour
  EXPECT_EQ(sharp[15].a, 255);
}

TEST(BlockFormats, ValuesAreMeansOfTwo) {
  // Indices 0 to 7 of three bits.
  const Bytes down = {70, 0, 0x88, 0xc6, 0xfa, 0, 0, 0}, up = {0, 50, 0x88, 0xc6, 0xfa, 0, 0, 0};
  const std::uint8_t eight[] = {70, 0, 60, 50, 40, 30, 20, 10}, six[] = {0, 50, 10, 20, 30, 40, 0, 255};
  Bytes both = down;
  both.insert(both.end(), up.begin(), up.end());
  const auto single = decoded(BlockFormat::Bc4, down), pair = decoded(BlockFormat::Bc5, both);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(single[i], (Rgba8{eight[i], 0, 0, 255})) << i;
    EXPECT_EQ(pair[i], (Rgba8{eight[i], six[i], 0, 255})) << i;
  }
  EXPECT_EQ(decoded(BlockFormat::Bc3, both)[2].a, 60);
}

TEST(BlockFormats, Bc7HasTheTexelsOfAnotherDecoder) {
  // FNV-1a of 800 blocks, 100 of each mode, of pseudorandom bits: that of bcdec 0.98.
  std::uint64_t sum = 14695981039346656037u;
  for (std::uint32_t n = 0; n < 800; ++n) {
    Bytes block;
    for (std::uint32_t i = 0; i < 16; ++i) block.push_back(static_cast<std::uint8_t>(hash(n, i)));
    const auto mode = 1u << n % 8;
    block[0] = static_cast<std::uint8_t>((block[0] & ~(2 * mode - 1)) | mode);
    for (const Rgba8& p : decoded(BlockFormat::Bc7, block))
      for (const std::uint8_t byte : {p.r, p.g, p.b, p.a}) sum = (sum ^ byte) * 1099511628211u;
  }
  EXPECT_EQ(sum, 0xa4e62137db743c40u);
  EXPECT_EQ(decoded(BlockFormat::Bc7, Bytes(16, 0))[5], (Rgba8{0, 0, 0, 0}));
}

TEST(BlockFormats, FilesHoldThem) {
  Bytes file{0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
  const auto put = [&](std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) file.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  };
  constexpr std::uint32_t bc1_srgb = 132, descriptor = 44;
  for (const std::uint32_t word : {bc1_srgb, 1u, 5u, 3u, 0u, 0u, 1u, 1u, 0u, 104u, descriptor, 0u, 0u}) put(word, 4);
  put(0, 8), put(0, 8), put(148, 8), put(16, 8), put(16, 8);
  file.resize(148);
  for (const int code : {0xf8, 0x07}) put(static_cast<std::uint64_t>(code) << 8, 8);  // red, green at full strength
  const Rgba8Image image = decode_ktx2(file, "tex", 100).as<Rgba8>();
  EXPECT_EQ(image.width(), 5);
  EXPECT_EQ(image.height(), 3);
  EXPECT_EQ(image(3, 2), (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(image(4, 0), (Rgba8{0, 227, 0, 255}));
  file.pop_back();
  EXPECT_THROW(decode_ktx2(file, "tex", 100), Error);
}

}  // namespace
}  // namespace zoneplate
