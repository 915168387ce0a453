// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace zoneplate {

/// A big-endian number of `size` bytes, at most eight.
///
/// Requires  the bytes are there.
inline std::uint64_t big_endian(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
  return value;
}

/// Calls use(name, contents) for the boxes of AVIF and JPEG XL, up to the first that is cut off, or for which it
/// returns false.
///
/// Source    ISO/IEC 14496-12, section 4.2.
template <class Use>
void for_boxes(std::span<const std::uint8_t> bytes, const Use& use) {
  while (bytes.size() >= 8) {
    std::uint64_t size = big_endian(bytes, 0, 4);
    std::size_t header = 8;
    if (size == 1 && bytes.size() >= 16) size = big_endian(bytes, 8, 8), header = 16;
    if (size == 0) size = bytes.size();
    if (size < header || size > bytes.size()) return;
    const std::string_view name(reinterpret_cast<const char*>(bytes.data()) + 4, 4);
    if (!use(name, bytes.subspan(header, static_cast<std::size_t>(size) - header))) return;
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
}

}  // namespace zoneplate
