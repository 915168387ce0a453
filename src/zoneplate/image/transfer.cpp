// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/transfer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer_lanes.h"
#include "zoneplate/image/transfer_rows.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {
namespace {

/// The definition of the decoding curve, in double precision: x^2.4 = x^2 (x^2)^(1/5), with the root by Newton's
/// method.
constexpr double decode_precisely(double code) {
  if (code <= 0.04045) return code / 12.92;
  const double x = (code + 0.055) / 1.055, square = x * x;
  double root = 1;
  for (int i = 0; i < 20; ++i) root -= (root - square / (root * root * root * root)) / 5;
  return square * root;
}

constexpr std::array<float, 256> decoded = [] {
  std::array<float, 256> table{};
  for (std::size_t code = 0; code < 256; ++code) {
    table[code] = static_cast<float>(decode_precisely(static_cast<double>(code) / 255));
  }
  return table;
}();

/// The least linear value of each 8-bit code; and for each run of 2^16 consecutive floats, the code at its beginning.
///
/// A run between 2^-13 and 1 contains at most one such value, so that a code is that of the run or the next one.
struct Thresholds {
  static constexpr std::uint32_t first_bits = 0x39000000;  // 2^-13, below the least value of code 1
  static constexpr std::uint32_t one_bits = 0x3f800000;
  static constexpr int run_shift = 16;

  std::array<float, 257> least{};
  std::array<std::uint8_t, ((one_bits - first_bits) >> run_shift) + 1> begin{};

  constexpr Thresholds() {
    for (std::uint32_t code = 1; code < 256; ++code) {
      const double value = decode_precisely((code - 0.5) / 255);
      const float near = static_cast<float>(value);
      const std::uint32_t above = std::bit_cast<std::uint32_t>(near) + 1;
      least[code] = static_cast<double>(near) >= value ? near : std::bit_cast<float>(above);
    }
    least[256] = 2;
    std::size_t code = 0;
    for (std::uint32_t run = 0; run < begin.size(); ++run) {
      const float x = std::bit_cast<float>(first_bits + (run << run_shift));
      while (least[code + 1] <= x) ++code;
      begin[run] = static_cast<std::uint8_t>(code);
    }
  }
};
constexpr Thresholds thresholds;

}  // namespace

float encode_srgb(float linear) { return encode_srgb(scalar::Float(linear)).v; }

float decode_srgb(float code) { return decode_srgb(scalar::Float(code)).v; }

float decode_srgb8(std::uint8_t code) { return decoded[code]; }

std::vector<float> decoded_srgb16() {
  std::vector<float> table(65536);
  for (std::size_t code = 0; code < table.size(); ++code)
    table[code] = static_cast<float>(decode_precisely(static_cast<double>(code) / 65535));
  return table;
}

std::uint8_t encode_srgb8(float linear) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(clamp_unit(scalar::Float(linear)).v);
  if (bits < Thresholds::first_bits) return 0;
  const std::uint8_t code = thresholds.begin[(bits - Thresholds::first_bits) >> Thresholds::run_shift];
  return static_cast<std::uint8_t>(code + (std::bit_cast<float>(bits) >= thresholds.least[code + 1u] ? 1 : 0));
}

namespace {

/// The four channels of all rows are processed as one array; a block has some hundred kilobytes.
template <class Pixel, class Code>
Plane<Pixel> quantize(const DisplayImage& image, void (*row)(const float*, Code*, std::size_t)) {
  static_assert(sizeof(Display) == 4 * sizeof(float) && sizeof(Pixel) == 4 * sizeof(Code));
  Plane<Pixel> out = Plane<Pixel>::unset(image.width(), image.height());
  parallel_ranges(image.values().size(), 16384, [&](std::size_t begin, std::size_t end) {
    row(&image.values()[begin].r, &out.values()[begin].r, 4 * (end - begin));
  });
  return out;
}

}  // namespace

Rgba8Image quantize8(const DisplayImage& image) { return quantize<Rgba8>(image, TransferKernels::of().quantize8); }

Rgba16Image quantize16(const DisplayImage& image) { return quantize<Rgba16>(image, TransferKernels::of().quantize16); }

}  // namespace zoneplate
