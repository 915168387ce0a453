// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/uastc.h"

#include <algorithm>

#include "zoneplate/base/deadline.h"

namespace zoneplate::ktx2 {
namespace {

/// A mode of UASTC: a subset of an ASTC 4 × 4 block. The endpoints' numbers have `endpoint_bits` bits and a trit (0 to
/// 2) or a quint (0 to 4) above them.
struct Mode {
  std::uint8_t code_bits;  ///< of the mode's number, in the block's first bits
  std::uint8_t hint_bits;  ///< for encoders of other formats
  std::uint8_t pattern_bits, subsets, planes, channels, weight_bits, endpoint_bits;
  std::uint8_t base;  ///< 1: bits alone; 3: with trits; 5: with quints
};
constexpr std::size_t mode_count = 19, solid_mode = 8;
constexpr Mode modes[mode_count] = {
    {4, 15, 0, 1, 1, 3, 4, 6, 3}, {6, 15, 0, 1, 1, 3, 2, 8, 1}, {5, 15, 5, 2, 1, 3, 3, 4, 1},
    {5, 15, 4, 3, 1, 3, 2, 2, 3}, {5, 15, 5, 2, 1, 3, 2, 3, 5}, {5, 15, 0, 1, 1, 3, 3, 8, 1},
    {5, 15, 0, 1, 2, 3, 2, 5, 5}, {5, 15, 5, 2, 1, 3, 2, 3, 5}, {5, 0, 0, 1, 1, 4, 0, 0, 1},
    {5, 23, 5, 2, 1, 4, 2, 4, 1}, {3, 17, 0, 1, 1, 4, 4, 4, 3}, {2, 17, 0, 1, 2, 4, 2, 4, 3},
    {3, 17, 0, 1, 1, 4, 3, 6, 3}, {5, 23, 0, 1, 2, 4, 1, 8, 1}, {5, 23, 0, 1, 1, 4, 2, 8, 1},
    {7, 23, 0, 1, 1, 2, 4, 8, 1}, {6, 23, 5, 2, 1, 2, 2, 8, 1}, {6, 23, 0, 1, 2, 2, 2, 8, 1},
    {4, 15, 0, 1, 1, 3, 5, 5, 1}};
/// The first bits of each mode's blocks.
constexpr std::uint8_t mode_codes[mode_count] = {0x01, 0x35, 0x1d, 0x03, 0x13, 0x0b, 0x1b, 0x07, 0x17, 0x0f,
                                                 0x02, 0x00, 0x06, 0x1f, 0x0d, 0x05, 0x15, 0x25, 0x09};

/// The partitions by their ASTC seeds: of two subsets that BC7 has too, of three, and (mode 7) of two that BC7 has
/// with three.
constexpr std::uint16_t seeds2[] = {28, 20,  16,  29, 91,  9,   107, 72,  149, 204, 50,  114, 496, 17,  78,
                                    39, 252, 828, 43, 156, 116, 210, 476, 273, 684, 359, 246, 195, 694, 524};
constexpr std::uint16_t seeds3[] = {260, 74, 32, 156, 183, 15, 745, 0, 335, 902, 254};
constexpr std::uint16_t seeds7[] = {36,  48,  61,  137, 161, 183, 226, 281, 302, 307,
                                    479, 495, 593, 594, 605, 799, 812, 988, 993};

/// The subset of a texel. Source: ASTC, "Partition Pattern Generation" (Khronos Data Format Specification), for blocks
/// of fewer than 31 texels.
int subset_of(std::uint32_t seed, int x, int y, std::uint32_t subsets) {
  std::uint32_t r = seed + (subsets - 1) * 1024;
  r ^= r >> 15, r -= r << 17, r += r << 7, r += r << 4, r ^= r >> 5, r += r << 16, r ^= r >> 7, r ^= r >> 3,
      r ^= r << 6;
  r ^= r >> 17;
  const std::uint32_t from = seed + (subsets - 1) * 1024;
  const unsigned first = subsets == 3 ? 6 : 5, second = (from & 2) != 0 ? 4 : 5;
  const unsigned along_x = (from & 1) != 0 ? second : first, along_y = (from & 1) != 0 ? first : second;
  const auto factor = [&](unsigned shift, unsigned by) {
    const std::uint32_t s = r >> shift & 15;
    return static_cast<int>(s * s >> by);
  };
  const auto plane = [&](unsigned shift, unsigned offset) {
    return (factor(shift, along_x) * 2 * x + factor(shift + 4, along_y) * 2 * y + static_cast<int>(r >> offset)) & 63;
  };
  const int a = plane(0, 14), b = plane(8, 10), c = subsets < 3 ? 0 : plane(16, 6);
  if (a >= b && a >= c) return 0;
  return b >= c ? 1 : 2;
}

/// A number of an endpoint as 8 bits. Source: ASTC, "Endpoint Unquantization".
std::uint8_t unquantized(std::uint32_t number, const Mode& mode) {
  const unsigned n = mode.endpoint_bits;
  const std::uint32_t bits = number & ((1u << n) - 1), high = number >> n;
  if (mode.base == 1) {
    std::uint32_t value = 0;  // the bits, repeated
    for (int shift = 8 - static_cast<int>(n); shift > -static_cast<int>(n); shift -= static_cast<int>(n))
      value |= shift >= 0 ? bits << shift : bits >> -shift;
    return static_cast<std::uint8_t>(value);
  }
  // Bit k of the number above its lowest, from b on.
  const auto b = [&](unsigned k) { return bits >> k & 1; };
  std::uint32_t spread = 0, factor = 0;
  if (mode.base == 3) {
    static constexpr std::uint32_t factors[] = {0, 204, 93, 44, 22, 11, 5};
    factor = factors[n];
    if (n == 2) spread = b(1) * 0b100010110;
    if (n == 3) spread = b(2) * 0b100001000 + b(1) * 0b010000100 + b(2) * 0b10 + b(1);
    if (n == 4) spread = (bits >> 1) << 6 | bits >> 1;
    if (n == 5) spread = (bits >> 1) << 5 | bits >> 3;
    if (n == 6) spread = (bits >> 1) << 4 | bits >> 5;
  } else {
    static constexpr std::uint32_t factors[] = {0, 113, 54, 26, 13, 6};
    factor = factors[n];
    if (n == 2) spread = b(1) * 0b100001100;
    if (n == 3) spread = (bits >> 1) << 7 | (bits >> 1) << 1 | b(2);
    if (n == 4) spread = (bits >> 1) << 6 | bits >> 2;
    if (n == 5) spread = (bits >> 1) << 5 | bits >> 4;
  }
  const std::uint32_t inverse = (bits & 1) != 0 ? 0x1ff : 0;
  const std::uint32_t sum = (high * factor + spread) ^ inverse;
  return static_cast<std::uint8_t>((inverse & 0x80) | sum >> 2);
}

/// The weights of a number of levels, in 1/64. Source: ASTC, "Weight Unquantization".
int weight_of(std::uint32_t index, unsigned bits) {
  std::uint32_t value = 0;
  for (int shift = 6 - static_cast<int>(bits); shift > -static_cast<int>(bits); shift -= static_cast<int>(bits))
    value |= shift >= 0 ? index << shift : index >> -shift;
  return static_cast<int>(value > 32 ? value + 1 : value);
}

/// The trits or quints come first, five or three to a number, then the bits of all endpoints.
struct Endpoints {
  static constexpr std::size_t most = 18;
  std::uint8_t value[most];

  Endpoints(BitReader& bits, const Mode& mode) {
    const std::size_t count = 2u * mode.channels * mode.subsets, pack = mode.base == 3 ? 5 : 3;
    static constexpr unsigned trit_bits[] = {0, 2, 4, 5, 7, 8}, quint_bits[] = {0, 3, 5, 7};
    std::uint32_t high[most] = {};
    for (std::size_t first = 0; mode.base > 1 && first < count; first += pack) {
      const std::size_t size = std::min(pack, count - first);
      std::uint32_t packed = bits.take(mode.base == 3 ? trit_bits[size] : quint_bits[size]);
      for (std::size_t i = 0; i < size; ++i, packed /= mode.base) high[first + i] = packed % mode.base;
    }
    for (std::size_t i = 0; i < count; ++i)
      value[i] = unquantized(bits.take(mode.endpoint_bits) | high[i] << mode.endpoint_bits, mode);
  }
};

/// The subsets of a block's texels.
std::array<std::uint8_t, 16> read_pattern(BitReader& bits, std::size_t number, const Mode& mode) {
  std::array<std::uint8_t, 16> subset{};
  if (mode.subsets == 1) return subset;
  const std::span<const std::uint16_t> seeds = mode.subsets == 3 ? std::span<const std::uint16_t>(seeds3)
                                               : number == 7     ? std::span<const std::uint16_t>(seeds7)
                                                                 : std::span<const std::uint16_t>(seeds2);
  const std::uint32_t pattern = bits.take(mode.pattern_bits);
  if (pattern >= seeds.size()) bits.place().fail("a block has no such partition");
  for (int i = 0; i < 16; ++i)
    subset[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(subset_of(seeds[pattern], i % 4, i / 4, mode.subsets));
  return subset;
}

/// (l (64 - w) + h w + 32) / 64 of values of 16 bits, of which the upper 8 remain: the same as in ASTC for linear data.
std::uint8_t mixed(std::uint8_t low, std::uint8_t high, int weight) {
  const std::uint32_t l = low * 257u, h = high * 257u, w = static_cast<std::uint32_t>(weight);
  return static_cast<std::uint8_t>(((l * (64 - w) + h * w + 32) >> 6) >> 8);
}

std::size_t mode_of(std::uint8_t first) {
  for (std::size_t m = 0; m < mode_count; ++m)
    if ((first & ((1u << modes[m].code_bits) - 1)) == mode_codes[m]) return m;
  return mode_count;
}

}  // namespace

std::array<Rgba8, 16> decode_uastc_block(std::span<const std::uint8_t, uastc_block_bytes> block, const Place& place) {
  std::array<Rgba8, 16> texels;
  const std::size_t number = mode_of(block[0]);
  if (number == mode_count) place.fail("a block has no such mode");
  const Mode& mode = modes[number];
  BitReader bits(block, place);
  bits.take(mode.code_bits);
  if (number == solid_mode) {
    const auto byte = [&] { return static_cast<std::uint8_t>(bits.take(8)); };
    Rgba8 color;
    color.r = byte(), color.g = byte(), color.b = byte(), color.a = byte();
    texels.fill(color);
    return texels;
  }
  for (unsigned left = mode.hint_bits; left > 0; left -= std::min(left, 16u)) bits.take(std::min(left, 16u));
  const std::array<std::uint8_t, 16> subset = read_pattern(bits, number, mode);
  // Of two planes, the second has the weights of one channel alone: alpha of modes of two channels.
  const bool is_grey = mode.channels == 2;
  std::uint32_t own_channel = 4;
  if (mode.planes == 2) own_channel = is_grey ? 3 : bits.take(2);
  const Endpoints endpoints(bits, mode);

  bool is_begun[3] = {};
  for (std::size_t i = 0; i < 16; ++i) {
    // The first weight of each subset and plane has a bit less: its highest is 0.
    const unsigned size = mode.weight_bits - (is_begun[subset[i]] ? 0u : 1u);
    is_begun[subset[i]] = true;
    int weight[2];
    for (int plane = 0; plane < mode.planes; ++plane) weight[plane] = weight_of(bits.take(size), mode.weight_bits);
    const std::uint8_t* const e = endpoints.value + std::size_t{2} * mode.channels * subset[i];
    const auto channel = [&](std::uint32_t c, std::size_t from) {
      return mixed(e[2 * from], e[2 * from + 1], weight[c == own_channel ? 1 : 0]);
    };
    Rgba8& t = texels[i];
    if (is_grey)
      t.r = t.g = t.b = channel(0, 0), t.a = channel(3, 1);
    else
      t = {channel(0, 0), channel(1, 1), channel(2, 2), mode.channels == 4 ? channel(3, 3) : std::uint8_t{255}};
  }
  return texels;
}

void decode_uastc(std::span<const std::uint8_t> blocks, const Place& place, Rgba8Image& image) {
  const int columns = (image.width() + 3) / 4, rows = (image.height() + 3) / 4;
  for (int j = 0; j < rows; ++j) {
    check_deadline();
    for (int i = 0; i < columns; ++i) {
      const std::size_t at =
          (static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)) *
          uastc_block_bytes;
      const auto texels = decode_uastc_block(blocks.subspan(at).first<uastc_block_bytes>(), place);
      for (int y = 4 * j; y < std::min(4 * j + 4, image.height()); ++y)
        for (int x = 4 * i; x < std::min(4 * i + 4, image.width()); ++x)
          image(x, y) = texels[static_cast<std::size_t>(4 * (y % 4) + x % 4)];
    }
  }
}

}  // namespace zoneplate::ktx2
