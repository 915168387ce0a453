// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "zoneplate/codec/png/png_chunk.h"

namespace zoneplate {

/// Exif data of an orientation, in big-endian order.
inline std::vector<std::uint8_t> exif_of(std::uint8_t orientation) {
  return {'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 0x12, 0, 3, 0, 0, 0, 1, 0, orientation, 0, 0, 0, 0, 0, 0};
}

/// A PNG with another chunk after its header.
inline std::vector<std::uint8_t> png_with(std::vector<std::uint8_t> png, std::string_view name,
                                          const std::vector<std::uint8_t>& data) {
  std::vector<std::uint8_t> chunk;
  put_png_chunk(chunk, name, data);
  constexpr std::ptrdiff_t after_header = 33;
  png.insert(png.begin() + after_header, chunk.begin(), chunk.end());
  return png;
}

/// A JPEG with another segment at its start.
inline std::vector<std::uint8_t> jpeg_with(std::vector<std::uint8_t> jpeg, std::uint8_t marker, std::string_view prefix,
                                           const std::vector<std::uint8_t>& data) {
  const std::size_t size = 2 + prefix.size() + data.size();
  std::vector<std::uint8_t> segment = {0xff, marker, static_cast<std::uint8_t>(size >> 8),
                                       static_cast<std::uint8_t>(size)};
  segment.insert(segment.end(), prefix.begin(), prefix.end());
  segment.insert(segment.end(), data.begin(), data.end());
  jpeg.insert(jpeg.begin() + 2, segment.begin(), segment.end());
  return jpeg;
}

/// A JPEG with an orientation.
inline std::vector<std::uint8_t> turned_jpeg(std::vector<std::uint8_t> jpeg, std::uint8_t orientation) {
  return jpeg_with(std::move(jpeg), 0xe1, {"Exif\0\0", 6}, exif_of(orientation));
}

}  // namespace zoneplate
