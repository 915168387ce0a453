// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace zoneplate {

/// A little-endian number of `size` bytes, at most four.
///
/// Requires  the bytes are there.
inline std::uint32_t little_endian(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | bytes[at + i];
  return value;
}

/// The bits of a value under a mask of adjacent bits as a share of 255, rounded; 0 if the mask is empty.
inline std::uint8_t unorm8_under(std::uint32_t mask, std::uint32_t value) {
  if (mask == 0) return 0;
  const std::uint64_t most = mask >> std::countr_zero(mask), found = (value & mask) >> std::countr_zero(mask);
  return static_cast<std::uint8_t>((found * 255 + most / 2) / most);
}

}  // namespace zoneplate
