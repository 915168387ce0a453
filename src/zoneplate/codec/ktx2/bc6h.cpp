// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/bc6h.h"

#include <algorithm>
#include <string_view>

#include "zoneplate/base/deadline.h"
#include "zoneplate/codec/ktx2/bptc.h"
#include "zoneplate/image/half.h"

namespace zoneplate::ktx2 {
namespace {

constexpr unsigned channels = 3, endpoints = 4, value_bits = 16;
constexpr std::size_t max_layout_bits = 75;  // of the endpoints of a block

/// Which bit of which endpoint the bits after the mode are, in their order: 16 × (3 × endpoint + channel) + bit.
struct Layout {
  std::array<std::uint8_t, max_layout_bits> place{};
  std::size_t count = 0;
};

/// Parses the specification's notation: `rw9:0` are the bits 0 to 9 of endpoint w's red, the bit on the right first,
/// `gz4` is one bit. Endpoints are w and x of the first subset, y and z of the second.
consteval Layout layout(std::string_view text) {
  Layout out;
  std::size_t at = 0;
  const auto number = [&] {
    unsigned n = 0;
    while (at < text.size() && text[at] >= '0' && text[at] <= '9') n = 10 * n + static_cast<unsigned>(text[at++] - '0');
    return n;
  };
  while (at < text.size()) {
    const auto channel = static_cast<unsigned>(std::string_view("rgb").find(text[at]));
    const auto endpoint = static_cast<unsigned>(std::string_view("wxyz").find(text[at + 1]));
    at += 2;
    const unsigned last = number();
    unsigned bit = last;
    if (at < text.size() && text[at] == ':') ++at, bit = number();
    for (;; bit < last ? ++bit : --bit) {
      out.place[out.count++] = static_cast<std::uint8_t>(value_bits * (channels * endpoint + channel) + bit);
      if (bit == last) break;
    }
    if (at < text.size()) ++at;  // a space
  }
  return out;
}

/// A mode: its bits in the order of the stream, how many of them there are, the bits of an endpoint and of the
/// differences of the others from the first, by channel. Without `has_differences`, all endpoints are stored whole.
struct Mode {
  unsigned code, code_bits, subsets, bits, difference_bits[channels];
  bool has_differences;
  Layout layout;
};

constexpr Mode modes[] = {
    {0b00,
     2,
     2,
     10,
     {5, 5, 5},
     true,
     layout("gy4 by4 bz4 rw9:0 gw9:0 bw9:0 rx4:0 gz4 gy3:0 gx4:0 bz0 gz3:0 bx4:0 bz1 by3:0 ry4:0 bz2 rz4:0 bz3")},
    {0b01,
     2,
     2,
     7,
     {6, 6, 6},
     true,
     layout("gy5 gz4 gz5 rw6:0 bz0 bz1 by4 gw6:0 by5 bz2 gy4 bw6:0 bz3 bz5 bz4 rx5:0 gy3:0 gx5:0 gz3:0 bx5:0 by3:0 "
            "ry5:0 rz5:0")},
    {0b00010,
     5,
     2,
     11,
     {5, 4, 4},
     true,
     layout("rw9:0 gw9:0 bw9:0 rx4:0 rw10 gy3:0 gx3:0 gw10 bz0 gz3:0 bx3:0 bw10 bz1 by3:0 ry4:0 bz2 rz4:0 bz3")},
    {0b00110,
     5,
     2,
     11,
     {4, 5, 4},
     true,
     layout("rw9:0 gw9:0 bw9:0 rx3:0 rw10 gz4 gy3:0 gx4:0 gw10 gz3:0 bx3:0 bw10 bz1 by3:0 ry3:0 bz0 bz2 rz3:0 gy4 "
            "bz3")},
    {0b01010,
     5,
     2,
     11,
     {4, 4, 5},
     true,
     layout("rw9:0 gw9:0 bw9:0 rx3:0 rw10 by4 gy3:0 gx3:0 gw10 bz0 gz3:0 bx4:0 bw10 by3:0 ry3:0 bz1 bz2 rz3:0 bz4 "
            "bz3")},
    {0b01110,
     5,
     2,
     9,
     {5, 5, 5},
     true,
     layout("rw8:0 by4 gw8:0 gy4 bw8:0 bz4 rx4:0 gz4 gy3:0 gx4:0 bz0 gz3:0 bx4:0 bz1 by3:0 ry4:0 bz2 rz4:0 bz3")},
    {0b10010,
     5,
     2,
     8,
     {6, 5, 5},
     true,
     layout("rw7:0 gz4 by4 gw7:0 bz2 gy4 bw7:0 bz3 bz4 rx5:0 gy3:0 gx4:0 bz0 gz3:0 bx4:0 bz1 by3:0 ry5:0 rz5:0")},
    {0b10110,
     5,
     2,
     8,
     {5, 6, 5},
     true,
     layout("rw7:0 bz0 by4 gw7:0 gy5 gy4 bw7:0 gz5 bz4 rx4:0 gz4 gy3:0 gx5:0 gz3:0 bx4:0 bz1 by3:0 ry4:0 bz2 rz4:0 "
            "bz3")},
    {0b11010,
     5,
     2,
     8,
     {5, 5, 6},
     true,
     layout("rw7:0 bz1 by4 gw7:0 by5 gy4 bw7:0 bz5 bz4 rx4:0 gz4 gy3:0 gx4:0 bz0 gz3:0 bx5:0 by3:0 ry4:0 bz2 rz4:0 "
            "bz3")},
    {0b11110,
     5,
     2,
     6,
     {6, 6, 6},
     false,
     layout("rw5:0 gz4 bz0 bz1 by4 gw5:0 gy5 by5 bz2 gy4 bw5:0 gz5 bz3 bz5 bz4 rx5:0 gy3:0 gx5:0 gz3:0 bx5:0 by3:0 "
            "ry5:0 rz5:0")},
    {0b00011, 5, 1, 10, {10, 10, 10}, false, layout("rw9:0 gw9:0 bw9:0 rx9:0 gx9:0 bx9:0")},
    {0b00111, 5, 1, 11, {9, 9, 9}, true, layout("rw9:0 gw9:0 bw9:0 rx8:0 rw10 gx8:0 gw10 bx8:0 bw10")},
    {0b01011, 5, 1, 12, {8, 8, 8}, true, layout("rw9:0 gw9:0 bw9:0 rx7:0 rw10:11 gx7:0 gw10:11 bx7:0 bw10:11")},
    {0b01111, 5, 1, 16, {4, 4, 4}, true, layout("rw9:0 gw9:0 bw9:0 rx3:0 rw10:15 gx3:0 gw10:15 bx3:0 bw10:15")}};

const Mode* read_mode(BitReader& bits) {
  unsigned code = bits.take(2), count = 2;
  if (code > 1) code |= bits.take(3) << 2, count = 5;
  const auto* const mode =
      std::ranges::find_if(modes, [&](const Mode& m) { return m.code == code && m.code_bits == count; });
  return mode == std::end(modes) ? nullptr : mode;
}

std::int32_t sign_extended(std::int32_t value, unsigned bits) {
  const std::int32_t sign = std::int32_t{1} << (bits - 1);
  return (value & (2 * sign - 1)) >= sign ? (value & (2 * sign - 1)) - 2 * sign : value & (2 * sign - 1);
}

/// The endpoints, by endpoint and channel, with the differences added.
void read_endpoints(BitReader& bits, const Mode& mode, bool is_signed, std::int32_t (&out)[endpoints][channels]) {
  for (std::size_t i = 0; i < mode.layout.count; ++i) {
    const unsigned place = mode.layout.place[i], value = place / value_bits;
    out[value / channels][value % channels] |= static_cast<std::int32_t>(bits.bit() << place % value_bits);
  }
  for (unsigned c = 0; c < channels; ++c) {
    if (is_signed) out[0][c] = sign_extended(out[0][c], mode.bits);
    for (unsigned e = 1; e < 2 * mode.subsets; ++e) {
      std::int32_t& value = out[e][c];
      if (is_signed || mode.has_differences) value = sign_extended(value, mode.difference_bits[c]);
      if (!mode.has_differences) continue;
      value = (out[0][c] + value) & ((std::int32_t{1} << mode.bits) - 1);
      if (is_signed) value = sign_extended(value, mode.bits);
    }
  }
}

/// An endpoint, widened to 16 bits.
std::int32_t widened(std::int32_t value, unsigned bits, bool is_signed) {
  if (!is_signed) {
    if (bits >= 15 || value == 0) return value;
    return value == (1 << bits) - 1 ? 0xffff : ((value << 16) + 0x8000) >> bits;
  }
  if (bits >= 16 || value == 0) return value;
  const std::int32_t size = std::abs(value), widest = (1 << (bits - 1)) - 1;
  const std::int32_t wide = size >= widest ? 0x7fff : ((size << 15) + 0x4000) >> (bits - 1);
  return value < 0 ? -wide : wide;
}

/// The half float of an interpolated value.
float light_of(std::int32_t value, bool is_signed) {
  if (!is_signed) return half_value(static_cast<std::uint16_t>((value * 31) >> 6));
  const std::int32_t size = (std::abs(value) * 31) >> 5;
  return half_value(static_cast<std::uint16_t>(size | (value < 0 ? 0x8000 : 0)));
}

}  // namespace

std::array<float4, 16> decode_bc6h_block(std::span<const std::uint8_t> block, bool is_signed, const Place& place) {
  std::array<float4, 16> out;
  out.fill({0, 0, 0, 1});
  BitReader bits(block, place);
  const Mode* const mode = read_mode(bits);
  if (mode == nullptr) return out;

  std::int32_t end[endpoints][channels] = {};
  read_endpoints(bits, *mode, is_signed, end);
  for (auto& endpoint : end)
    for (std::int32_t& value : endpoint) value = widened(value, mode->bits, is_signed);
  const std::uint32_t partition = mode->subsets == 2 ? bits.take(5) : 0;
  const unsigned index_bits = mode->subsets == 2 ? 3 : 4;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint32_t index = bits.take(index_bits - (is_anchor(mode->subsets, partition, i) ? 1 : 0));
    const auto weight = static_cast<std::int32_t>(weight_of(index, index_bits));
    const std::uint32_t first = 2 * subset_of(mode->subsets, partition, i);
    const auto channel = [&](unsigned c) {
      return light_of(((64 - weight) * end[first][c] + weight * end[first + 1][c] + 32) >> 6, is_signed);
    };
    out[i] = {channel(0), channel(1), channel(2), 1};
  }
  return out;
}

void decode_bc6h(std::span<const std::uint8_t> blocks, bool is_signed, const Place& place, Plane<float4>& image) {
  std::size_t at = 0;
  for (int y = 0; y < image.height(); y += 4) {
    check_deadline();
    for (int x = 0; x < image.width(); x += 4, at += bc6h_block_bytes) {
      const std::array<float4, 16> texels = decode_bc6h_block(blocks.subspan(at, bc6h_block_bytes), is_signed, place);
      for (int j = 0; j < std::min(4, image.height() - y); ++j)
        for (int i = 0; i < std::min(4, image.width() - x); ++i)
          image(x + i, y + j) = texels[static_cast<std::size_t>(4 * j + i)];
    }
  }
}

}  // namespace zoneplate::ktx2
