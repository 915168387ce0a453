// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/meshopt/vertex_stream.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <type_traits>
#include <vector>

namespace zoneplate {
namespace {

constexpr std::size_t group_size = 16, max_block_bytes = 8192, max_block_elements = 256, min_tail = 24;

/// The bytes that are left of a stream.
class ByteQueue {
 public:
  explicit ByteQueue(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool is_empty() const { return bytes_.empty(); }

  /// The next bytes; nothing where there are fewer.
  std::optional<std::span<const std::uint8_t>> take(std::size_t count) {
    if (count > bytes_.size()) return std::nullopt;
    const auto taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

/// Number i of a group of `bits` bits each: single bits begin with the lowest of a byte, others with the highest.
unsigned packed_number(std::span<const std::uint8_t> bytes, std::size_t i, unsigned bits) {
  const std::size_t per_byte = 8 / bits, within = i % per_byte;
  const std::size_t shift = bits == 1 ? within : 8 - bits * (within + 1);
  return static_cast<unsigned>(bytes[i / per_byte]) >> shift & ((1u << bits) - 1);
}

/// Sixteen deltas of `bits` bits (0: all are zero, 8: as they are); the greatest number stands for a byte that follows.
bool read_group(ByteQueue& bytes, unsigned bits, std::uint8_t* out) {
  if (bits == 0) {
    std::fill_n(out, group_size, std::uint8_t{0});
    return true;
  }
  const auto numbers = bytes.take(group_size * bits / 8);
  if (!numbers) return false;
  const unsigned sentinel = (1u << bits) - 1;
  for (std::size_t i = 0; i < group_size; ++i) {
    const unsigned number = packed_number(*numbers, i, bits);
    out[i] = static_cast<std::uint8_t>(number);
    if (bits == 8 || number != sentinel) continue;
    const auto byte = bytes.take(1);
    if (!byte) return false;
    out[i] = (*byte)[0];
  }
  return true;
}

/// The deltas of one byte of the elements of a block.
bool read_deltas(ByteQueue& bytes, unsigned control, std::size_t elements, std::vector<std::uint8_t>& out) {
  const std::size_t groups = (elements + group_size - 1) / group_size;
  out.assign(groups * group_size, 0);
  if (control == 2) return true;
  if (control == 3) {
    const auto literal = bytes.take(elements);
    if (literal) std::copy(literal->begin(), literal->end(), out.begin());
    return literal.has_value();
  }
  constexpr unsigned widths[2][4] = {{0, 1, 2, 4}, {1, 2, 4, 8}};
  const auto header = bytes.take((groups + 3) / 4);
  if (!header) return false;
  for (std::size_t g = 0; g < groups; ++g) {
    const unsigned mode = static_cast<unsigned>((*header)[g / 4]) >> (2 * (g % 4)) & 3;
    if (!read_group(bytes, widths[control][mode], out.data() + g * group_size)) return false;
  }
  return true;
}

template <class Number>
Number unzigzag(Number v) {
  return static_cast<Number>((v & 1) != 0 ? ~(v >> 1) : v >> 1);
}

/// A value of four bytes after the one before it, by its deltas and the mode of its channel.
std::uint32_t next_value(std::uint32_t before, std::uint32_t delta, std::uint8_t channel) {
  std::uint32_t out = 0;
  if (channel == 0)
    for (int shift = 0; shift < 32; shift += 8)
      out |= static_cast<std::uint32_t>(
                 static_cast<std::uint8_t>((before >> shift) + unzigzag(static_cast<std::uint8_t>(delta >> shift))))
             << shift;
  if (channel == 1)
    for (int shift = 0; shift < 32; shift += 16)
      out |= static_cast<std::uint32_t>(
                 static_cast<std::uint16_t>((before >> shift) + unzigzag(static_cast<std::uint16_t>(delta >> shift))))
             << shift;
  if ((channel & 15) == 2) out = before ^ std::rotr(delta, channel >> 4);
  return out;
}

std::uint32_t load(const std::uint8_t* bytes) {
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8 |
         static_cast<std::uint32_t>(bytes[2]) << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}
void store(std::uint32_t value, std::uint8_t* bytes) {
  for (int k = 0; k < 4; ++k) bytes[k] = static_cast<std::uint8_t>(value >> (8 * k));
}

}  // namespace

bool decode_vertex_stream1(std::span<const std::uint8_t> packed, std::size_t stride, std::span<std::uint8_t> out) {
  // The tail: padding, the element before the first one, the modes of the channels.
  const std::size_t channels = stride / 4, tail = std::max(stride + channels, min_tail);
  if (!is_vertex_stream1(packed) || packed.size() < 1 + tail) return false;
  std::vector<std::uint8_t> before(packed.end() - static_cast<std::ptrdiff_t>(stride + channels),
                                   packed.end() - static_cast<std::ptrdiff_t>(channels));
  const auto modes = packed.last(channels);
  for (const std::uint8_t mode : modes)
    if ((mode & 15) > 2 || ((mode & 15) != 2 && mode > 15)) return false;

  ByteQueue bytes(packed.subspan(1, packed.size() - 1 - tail));
  const std::size_t block = std::min(max_block_bytes / stride & ~(group_size - 1), max_block_elements);
  std::vector<std::uint8_t> deltas[4];
  for (std::size_t first = 0, count = out.size() / stride; first < count; first += block) {
    const std::size_t elements = std::min(block, count - first);
    const auto controls = bytes.take(channels);
    if (!controls) return false;
    for (std::size_t channel = 0; channel < channels; ++channel) {
      for (unsigned k = 0; k < 4; ++k)
        if (!read_deltas(bytes, static_cast<unsigned>((*controls)[channel]) >> (2 * k) & 3, elements, deltas[k]))
          return false;
      std::uint32_t value = load(before.data() + 4 * channel);
      for (std::size_t i = 0; i < elements; ++i) {
        const std::uint8_t delta[4] = {deltas[0][i], deltas[1][i], deltas[2][i], deltas[3][i]};
        value = next_value(value, load(delta), modes[channel]);
        store(value, out.data() + (first + i) * stride + 4 * channel);
      }
      store(value, before.data() + 4 * channel);
    }
  }
  return bytes.is_empty();
}

namespace {

template <class Number>
void filter_colors(std::span<std::uint8_t> elements) {
  constexpr int greatest = static_cast<Number>(~Number{0});
  for (std::size_t at = 0; at + 4 * sizeof(Number) <= elements.size(); at += 4 * sizeof(Number)) {
    Number in[4];
    std::memcpy(in, elements.data() + at, sizeof in);
    using Signed = std::make_signed_t<Number>;
    const int scale = static_cast<int>((1u << std::bit_width(static_cast<unsigned>(in[3]))) - 1);
    const int y = in[0], orange = static_cast<Signed>(in[1]), green = static_cast<Signed>(in[2]);
    const int alpha = in[3] & (scale >> 1);
    const int out[4] = {y + orange - green, y + green, y - orange - green, alpha * 2 | (alpha & 1)};
    for (int c = 0; c < 4; ++c) {
      const float value = static_cast<float>(out[c]) * (static_cast<float>(greatest) / static_cast<float>(scale));
      in[c] = static_cast<Number>(std::clamp(value + 0.5f, 0.0f, static_cast<float>(greatest)));
    }
    std::memcpy(elements.data() + at, in, sizeof in);
  }
}

}  // namespace

void filter_colors(std::span<std::uint8_t> elements, std::size_t stride) {
  if (stride == 4)
    filter_colors<std::uint8_t>(elements);
  else
    filter_colors<std::uint16_t>(elements);
}

}  // namespace zoneplate
