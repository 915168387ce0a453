// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/meshopt/vertex_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A stream of version 1: blocks, then a tail of this first element and these channel modes.
Bytes stream_of(const Bytes& blocks, const Bytes& first, const Bytes& modes) {
  Bytes out = {0xa1};
  out.insert(out.end(), blocks.begin(), blocks.end());
  const std::size_t tail = first.size() + modes.size();
  if (tail < 24) out.insert(out.end(), 24 - tail, 0);
  out.insert(out.end(), first.begin(), first.end());
  out.insert(out.end(), modes.begin(), modes.end());
  return out;
}

Bytes decoded(const Bytes& stream, std::size_t stride, std::size_t count, bool expected = true) {
  Bytes out(stride * count);
  EXPECT_EQ(decode_vertex_stream1(stream, stride, out), expected);
  return out;
}

/// The specification's example of 4-bit deltas.
const Bytes example = {0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5};
const int example_deltas[16] = {-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0};

TEST(VertexStream, DecodesTheSpecificationsExample) {
  // Byte 0 has 4-bit deltas (control mode 0, delta mode 3), the others are all zero (control mode 2).
  Bytes block = {0xa8, 0x03};
  block.insert(block.end(), example.begin(), example.end());
  const Bytes out = decoded(stream_of(block, {100, 1, 2, 3}, {0}), 4, 16);
  int value = 100;
  for (std::size_t i = 0; i < 16; ++i) {
    value = (value + example_deltas[i]) & 255;
    EXPECT_EQ(out[4 * i], value) << i;
    EXPECT_EQ((Bytes{out[4 * i + 1], out[4 * i + 2], out[4 * i + 3]}), (Bytes{1, 2, 3}));
  }
}

TEST(VertexStream, DecodesNarrowDeltas) {
  // Control mode 1: delta mode 0 has one bit, lowest first, and a byte for each 1; mode 1 two bits, highest first.
  const Bytes one_bit = {0xa9, 0x00, 0x05, 0x80, 2, 4, 6};
  const Bytes out = decoded(stream_of(one_bit, {0, 0, 0, 0}, {0}), 4, 16);
  const int deltas[16] = {1, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3};
  int value = 0;
  for (std::size_t i = 0; i < 16; ++i) EXPECT_EQ(out[4 * i], value += deltas[i]) << i;
  const Bytes two_bits = {0xa9, 0x01, 0b00011011, 0, 0, 0, 20};
  const Bytes other = decoded(stream_of(two_bits, {0, 0, 0, 0}, {0}), 4, 3);
  EXPECT_EQ(other[0], 0);
  EXPECT_EQ(other[4], 255);
  EXPECT_EQ(other[8], 0);
}

/// Elements as the encoder's literal mode stores them, by the modes of their channels.
Bytes literal_stream(const std::vector<std::uint32_t>& values, std::size_t channels, const Bytes& modes) {
  const std::size_t stride = 4 * channels, count = values.size() / channels;
  const std::size_t block = std::min<std::size_t>(8192 / stride / 16 * 16, 256);
  Bytes blocks;
  std::vector<std::uint32_t> before(channels, 7);
  for (std::size_t first = 0; first < count; first += block) {
    blocks.insert(blocks.end(), channels, 0xff);
    const std::size_t elements = std::min(block, count - first);
    for (std::size_t c = 0; c < channels; ++c) {
      std::vector<std::uint32_t> deltas;
      for (std::size_t i = 0; i < elements; ++i) {
        const std::uint32_t v = values[(first + i) * channels + c], b = before[c];
        std::uint32_t delta = 0;
        const int width = modes[c] == 0 ? 8 : 16;
        for (int shift = 0; (modes[c] & 15) != 2 && shift < 32; shift += width) {
          const std::uint32_t mask = (1u << width) - 1, d = ((v >> shift) - (b >> shift)) & mask;
          const bool is_negative = (d >> (width - 1)) != 0;
          delta |= ((is_negative ? ~(d << 1) : d << 1) & mask) << shift;
        }
        if ((modes[c] & 15) == 2) delta = (v ^ b) << (modes[c] >> 4) | (v ^ b) >> ((32 - (modes[c] >> 4)) & 31);
        deltas.push_back(delta), before[c] = v;
      }
      for (int k = 0; k < 4; ++k)
        for (const std::uint32_t d : deltas) blocks.push_back(static_cast<std::uint8_t>(d >> (8 * k)));
    }
  }
  Bytes first;
  for (std::size_t c = 0; c < channels; ++c) first.insert(first.end(), {7, 0, 0, 0});
  return stream_of(blocks, first, modes);
}

TEST(VertexStream, DecodesEveryChannelMode) {
  constexpr std::size_t channels = 4;
  for (const std::size_t count : {1u, 15u, 256u, 300u, 600u}) {
    std::vector<std::uint32_t> values(count * channels);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = hash(static_cast<std::uint32_t>(i), 5u);
    const Bytes out = decoded(literal_stream(values, channels, {0, 1, 2, 0x72}), 4 * channels, count);
    EXPECT_EQ(std::memcmp(out.data(), values.data(), out.size()), 0) << count;
  }
}

TEST(VertexStream, RefusesInvalidStreams) {
  const Bytes good = literal_stream({1, 2, 3, 4}, 1, {0});
  EXPECT_EQ(decoded(good, 4, 4).size(), 16u);
  for (std::size_t size = 0; size < good.size(); ++size)
    decoded({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}, 4, 4, false);
  decoded(good, 4, 3, false);  // bytes are left
  decoded(literal_stream({1, 2, 3, 4}, 1, {3}), 4, 4, false);
  decoded(literal_stream({1, 2, 3, 4}, 1, {0x10}), 4, 4, false);
}

TEST(VertexStream, ColoursAreConvertedAtTheirPrecision) {
  // Eight bits: y = 100, co = 20, cg = -10, alpha 127 of 127 with the marking bit above it.
  Bytes eight = {100, 20, static_cast<std::uint8_t>(-10), 0xff};
  filter_colors(eight, 4);
  EXPECT_EQ(eight, (Bytes{130, 90, 90, 255}));
  // Six bits in eight: the scale is 63, alpha 0 of 31.
  Bytes six = {32, 0, 0, 0x20};
  filter_colors(six, 4);
  EXPECT_EQ(six, (Bytes{130, 130, 130, 0}));
  const std::uint16_t wide[4] = {1000, 0, 0, 0xffff};
  Bytes sixteen(8);
  std::memcpy(sixteen.data(), wide, 8);
  filter_colors(sixteen, 8);
  std::uint16_t out[4];
  std::memcpy(out, sixteen.data(), 8);
  EXPECT_EQ(out[0], 1000);
  EXPECT_EQ(out[3], 65535);
}

}  // namespace
}  // namespace zoneplate
