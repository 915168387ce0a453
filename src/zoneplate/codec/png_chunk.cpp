#include "zoneplate/codec/png_chunk.h"

#include <zlib.h>

namespace zoneplate {

void put_png_word(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t png_checksum(std::uint32_t crc, std::span<const std::uint8_t> bytes) {
  // Where there is nothing zlib would begin again.
  return bytes.empty() ? crc : static_cast<std::uint32_t>(crc32(crc, bytes.data(), static_cast<uInt>(bytes.size())));
}

void put_png_chunk(std::vector<std::uint8_t>& out, std::string_view name, std::span<const std::uint8_t> data,
                   std::uint32_t crc) {
  put_png_word(out, static_cast<std::uint32_t>(data.size()));
  out.insert(out.end(), name.begin(), name.end());
  out.insert(out.end(), data.begin(), data.end());
  put_png_word(out, crc);
}

void put_png_chunk(std::vector<std::uint8_t>& out, std::string_view name, std::span<const std::uint8_t> data) {
  const std::span name_bytes(reinterpret_cast<const std::uint8_t*>(name.data()), name.size());
  put_png_chunk(out, name, data, png_checksum(png_checksum(0, name_bytes), data));
}

}  // namespace zoneplate
