// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/bc.h"

#include <algorithm>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/codec/ktx2/bptc.h"

namespace zoneplate::ktx2 {
namespace {

using Block = std::array<Rgba8, 16>;

/// The weighted mean of two numbers of a maximum, as 8 bits, rounded to the nearest.
std::uint8_t mean8(std::uint32_t a, std::uint32_t b, std::uint32_t weight_a, std::uint32_t weight_b,
                   std::uint32_t most) {
  const std::uint32_t total = (weight_a + weight_b) * most;
  return static_cast<std::uint8_t>((255 * (weight_a * a + weight_b * b) + total / 2) / total);
}

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
  return bytes[at] | static_cast<std::uint32_t>(bytes[at + 1]) << 8;
}

/// Two colours of 5, 6 and 5 bits, and two bits a texel. With `has_cut`, the order of the colours selects three levels
/// and black, which is transparent with `has_alpha`.
void decode_colors(std::span<const std::uint8_t> bytes, bool has_cut, bool has_alpha, Block& out) {
  const std::uint32_t first = word(bytes, 0), second = word(bytes, 2);
  const bool is_cut = has_cut && first <= second;
  const auto level = [&](std::uint32_t a, std::uint32_t b) {
    const auto channel = [&](int shift, std::uint32_t most) {
      return mean8(first >> shift & most, second >> shift & most, a, b, most);
    };
    return Rgba8{channel(11, 31), channel(5, 63), channel(0, 31), 255};
  };
  const Rgba8 black{0, 0, 0, static_cast<std::uint8_t>(has_alpha ? 0 : 255)};
  const Rgba8 levels[4] = {level(1, 0), level(0, 1), is_cut ? level(1, 1) : level(2, 1), is_cut ? black : level(1, 2)};
  const std::uint32_t indices = word(bytes, 4) | word(bytes, 6) << 16;
  for (std::size_t i = 0; i < 16; ++i) out[i] = levels[indices >> (2 * i) & 3];
}

/// Two values of eight bits, and three bits a texel; the order of the values selects eight levels, or six with 0 and
/// 255.
void decode_values(std::span<const std::uint8_t> bytes, std::uint8_t Rgba8::*channel, Block& out) {
  const std::uint32_t first = bytes[0], second = bytes[1];
  std::uint8_t levels[8] = {bytes[0], bytes[1]};
  const std::uint32_t steps = first > second ? 7 : 5;
  for (std::uint32_t k = 1; k < steps; ++k) levels[k + 1] = mean8(first, second, steps - k, k, 255);
  if (steps == 5) levels[6] = 0, levels[7] = 255;
  std::uint64_t indices = 0;
  for (std::size_t i = 0; i < 6; ++i) indices |= std::uint64_t{bytes[2 + i]} << (8 * i);
  for (std::size_t i = 0; i < 16; ++i) out[i].*channel = levels[indices >> (3 * i) & 7];
}

/// A mode of BC7: numbers of subsets and of bits.
struct Mode {
  unsigned subsets, partition, rotation, selection, color, alpha;
  bool has_own_bits, has_shared_bits;  ///< a least bit for each endpoint, or for both of a subset
  unsigned index, second_index;
};
constexpr Mode bc7_modes[8] = {{3, 4, 0, 0, 4, 0, true, false, 3, 0},  {2, 6, 0, 0, 6, 0, false, true, 3, 0},
                               {3, 6, 0, 0, 5, 0, false, false, 2, 0}, {2, 6, 0, 0, 7, 0, true, false, 2, 0},
                               {1, 0, 2, 1, 5, 6, false, false, 2, 3}, {1, 0, 2, 0, 7, 8, false, false, 2, 2},
                               {1, 0, 0, 0, 7, 7, true, false, 4, 0},  {2, 6, 0, 0, 5, 5, true, false, 2, 0}};

Block decode_bc7(std::span<const std::uint8_t> bytes, const Place& place) {
  BitReader bits(bytes, place);
  std::size_t number = 0;
  while (number < 8 && bits.bit() == 0) ++number;
  Block out;
  out.fill({0, 0, 0, 0});
  if (number == 8) return out;
  const Mode& mode = bc7_modes[number];
  const std::uint32_t partition = bits.take(mode.partition), rotation = bits.take(mode.rotation);
  const bool is_swapped = bits.take(mode.selection) != 0;

  // Endpoints by channel and subset, with their least bits and then widened to eight.
  std::uint32_t ends[4][6] = {};
  const unsigned count = 2 * mode.subsets;
  for (unsigned c = 0; c < 4; ++c)
    for (unsigned e = 0; e < count; ++e) ends[c][e] = bits.take(c < 3 ? mode.color : mode.alpha);
  std::uint32_t least[6] = {};
  if (mode.has_own_bits)
    for (unsigned e = 0; e < count; ++e) least[e] = bits.bit();
  if (mode.has_shared_bits)
    for (unsigned e = 0; e < count; e += 2) least[e] = least[e + 1] = bits.bit();
  const unsigned more = mode.has_own_bits || mode.has_shared_bits ? 1 : 0;
  for (unsigned c = 0; c < 4; ++c)
    for (unsigned e = 0; e < count; ++e) {
      const unsigned width = (c < 3 ? mode.color : mode.alpha) + more;
      const std::uint32_t value = ends[c][e] << more | least[e];
      ends[c][e] = c == 3 && mode.alpha == 0 ? 255 : value << (8 - width) | value >> (2 * width - 8);
    }

  std::uint32_t first[16], second[16] = {};
  for (std::size_t i = 0; i < 16; ++i)
    first[i] = bits.take(mode.index - (is_anchor(mode.subsets, partition, i) ? 1 : 0));
  if (mode.second_index > 0)
    for (std::size_t i = 0; i < 16; ++i) second[i] = bits.take(mode.second_index - (i == 0 ? 1 : 0));
  for (std::size_t i = 0; i < 16; ++i) {
    const std::uint32_t subset = subset_of(mode.subsets, partition, i);
    const std::uint32_t weight = weight_of(first[i], mode.index);
    const std::uint32_t other = mode.second_index > 0 ? weight_of(second[i], mode.second_index) : weight;
    const auto channel = [&](unsigned c) {
      const std::uint32_t w = (c == 3) != is_swapped ? other : weight;
      return static_cast<std::uint8_t>(((64 - w) * ends[c][2 * subset] + w * ends[c][2 * subset + 1] + 32) >> 6);
    };
    Rgba8& texel = out[i] = {channel(0), channel(1), channel(2), channel(3)};
    if (rotation == 1) std::swap(texel.r, texel.a);
    if (rotation == 2) std::swap(texel.g, texel.a);
    if (rotation == 3) std::swap(texel.b, texel.a);
  }
  return out;
}

}  // namespace

std::optional<BlockFormat> block_format_of(std::uint32_t vulkan_format) {
  using enum BlockFormat;
  constexpr std::uint32_t bc4 = 139, bc5 = 141, bc7 = 145;
  constexpr BlockFormat first[] = {Bc1, Bc1, Bc1Alpha, Bc1Alpha, Bc2, Bc2, Bc3, Bc3, Bc4};  // from 131 on
  if (vulkan_format >= 131 && vulkan_format <= bc4) return first[vulkan_format - 131];
  if (vulkan_format == bc5) return Bc5;
  if (vulkan_format == bc7 || vulkan_format == bc7 + 1) return Bc7;
  return std::nullopt;
}

std::size_t block_bytes(BlockFormat format) {
  return format == BlockFormat::Bc1 || format == BlockFormat::Bc1Alpha || format == BlockFormat::Bc4 ? 8 : 16;
}

std::array<Rgba8, 16> decode_block(BlockFormat format, std::span<const std::uint8_t> block, const Place& place) {
  Block out;
  out.fill({0, 0, 0, 255});
  switch (format) {
    case BlockFormat::Bc1:
    case BlockFormat::Bc1Alpha:
      decode_colors(block, true, format == BlockFormat::Bc1Alpha, out);
      break;
    case BlockFormat::Bc2:
      decode_colors(block.subspan(8), false, false, out);
      for (std::size_t i = 0; i < 16; ++i)
        out[i].a = static_cast<std::uint8_t>(17 * (block[i / 2] >> (4 * (i % 2)) & 15));
      break;
    case BlockFormat::Bc3:
      decode_colors(block.subspan(8), false, false, out);
      decode_values(block, &Rgba8::a, out);
      break;
    case BlockFormat::Bc4:
      decode_values(block, &Rgba8::r, out);
      break;
    case BlockFormat::Bc5:
      decode_values(block, &Rgba8::r, out);
      decode_values(block.subspan(8), &Rgba8::g, out);
      break;
    case BlockFormat::Bc7:
      return decode_bc7(block, place);
  }
  return out;
}

void decode_blocks(BlockFormat format, std::span<const std::uint8_t> blocks, const Place& place, Rgba8Image& image) {
  const std::size_t bytes = block_bytes(format);
  std::size_t at = 0;
  for (int y = 0; y < image.height(); y += 4) {
    check_deadline();
    for (int x = 0; x < image.width(); x += 4, at += bytes) {
      const Block texels = decode_block(format, blocks.subspan(at, bytes), place);
      for (int j = 0; j < std::min(4, image.height() - y); ++j)
        for (int i = 0; i < std::min(4, image.width() - x); ++i)
          image(x + i, y + j) = texels[static_cast<std::size_t>(4 * j + i)];
    }
  }
}

}  // namespace zoneplate::ktx2
