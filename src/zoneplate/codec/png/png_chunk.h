// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace zoneplate {

// Chunks of PNG and APNG files (PNG specification, third edition, section 5.3).

/// Appends a four-byte big-endian number.
inline void put_png_word(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// Updates the checksum `crc` with more bytes; the initial value is 0.
inline std::uint32_t png_checksum(std::uint32_t crc, std::span<const std::uint8_t> bytes) {
  // For an empty span, whose pointer is null, crc32 would return its initial value.
  return bytes.empty() ? crc : static_cast<std::uint32_t>(crc32(crc, bytes.data(), static_cast<uInt>(bytes.size())));
}

/// Appends a whole chunk: length, name, data, and the checksum of name and data.
///
/// Requires  a name of four letters.
inline void put_png_chunk(std::vector<std::uint8_t>& out, std::string_view name, std::span<const std::uint8_t> data,
                          std::uint32_t crc) {
  put_png_word(out, static_cast<std::uint32_t>(data.size()));
  out.insert(out.end(), name.begin(), name.end());
  out.insert(out.end(), data.begin(), data.end());
  put_png_word(out, crc);
}

/// Appends a whole chunk and computes its checksum.
inline void put_png_chunk(std::vector<std::uint8_t>& out, std::string_view name, std::span<const std::uint8_t> data) {
  const std::span name_bytes(reinterpret_cast<const std::uint8_t*>(name.data()), name.size());
  put_png_chunk(out, name, data, png_checksum(png_checksum(0, name_bytes), data));
}

}  // namespace zoneplate
