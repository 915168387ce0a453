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

/// Reads a four-byte big-endian number.
///
/// Requires  four bytes.
inline std::uint32_t get_png_word(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | bytes[static_cast<std::size_t>(i)];
  return value;
}

/// Calls use(name, data) for the chunks of a PNG file in order while it returns true, up to the first that is cut off.
template <class Use>
void for_png_chunks(std::span<const std::uint8_t> file, const Use& use) {
  constexpr std::size_t signature = 8, frame = 12;  // a chunk's length, name and checksum
  for (std::size_t at = signature; file.size() >= at && file.size() - at >= frame;) {
    const std::size_t length = get_png_word(file.subspan(at));
    if (file.size() - at - frame < length) return;
    const std::string_view name(reinterpret_cast<const char*>(file.data()) + at + 4, 4);
    if (!use(name, file.subspan(at + 8, length))) return;
    at += frame + length;
  }
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
