// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

namespace zoneplate {

/// The bits of the 16-bit float (IEEE 754 binary16) nearest to `value`, ties to even.
///
/// Edges     values above 65504, including infinity, become 65504, so that no pixel becomes infinite; NaN becomes 0.
/// Exact     integer arithmetic only.
constexpr std::uint16_t half_bits(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value), sign = bits >> 16 & 0x8000;
  const std::uint32_t size = bits & 0x7fffffff;
  if (size > 0x7f800000) return 0;
  if (size >= 0x477fe000) return static_cast<std::uint16_t>(sign | 0x7bff);
  const std::uint32_t exponent = size >> 23;
  if (exponent < 102) return static_cast<std::uint16_t>(sign);  // below half of the least positive half

  // The significand loses 13 bits, or more if the result is subnormal (below 2^-14).
  const bool is_small = exponent < 113;
  const std::uint32_t lost = is_small ? 126 - exponent : 13;
  const std::uint32_t from = is_small ? (size & 0x7fffff) | 0x800000 : size - (112u << 23);
  const std::uint32_t kept = from >> lost, rest = from & ((1u << lost) - 1), middle = 1u << (lost - 1);
  const bool rounds_up = rest > middle || (rest == middle && (kept & 1));
  return static_cast<std::uint16_t>(sign | (kept + rounds_up));
}

/// A 16-bit float as it is stored.
struct Half {
  std::uint16_t bits;
  bool operator==(const Half&) const = default;
};

/// The value of 16-bit float bits.
constexpr float half_value(std::uint16_t bits) {
  const std::uint32_t sign = (bits & 0x8000u) << 16, exponent = bits >> 10 & 31, rest = bits & 0x3ffu;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000 | rest << 13);
  if (exponent != 0) return std::bit_cast<float>(sign | (exponent + 112) << 23 | rest << 13);
  const float size = static_cast<float>(rest) * 0x1p-24f;
  return sign ? -size : size;
}

}  // namespace zoneplate
