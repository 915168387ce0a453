#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace zoneplate {

// Chunks of PNG and APNG files (PNG specification, third edition, section 5.3).

/// Appends a number of four bytes, the high one first.
void put_png_word(std::vector<std::uint8_t>& out, std::uint32_t value);

/// The checksum of bytes that follow others whose checksum is `crc`; 0 begins.
std::uint32_t png_checksum(std::uint32_t crc, std::span<const std::uint8_t> bytes);

/// Appends a whole chunk: length, name, data, checksum.
///
/// Requires  a name of four letters.
void put_png_chunk(std::vector<std::uint8_t>& out, std::string_view name, std::span<const std::uint8_t> data);

/// The same where the checksum of name and data is known.
void put_png_chunk(std::vector<std::uint8_t>& out, std::string_view name, std::span<const std::uint8_t> data,
                   std::uint32_t crc);

}  // namespace zoneplate
