// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// True for the first bytes of a JPEG.
bool is_jpeg(std::span<const std::uint8_t> bytes);

/// The contents of a JPEG's frame header.
struct JpegFrame {
  int2 size;
  std::uint64_t samples = 0;  ///< samples of all components in `pixels` pixels: 6 in 4 with 4:2:0 subsampling
  std::uint64_t pixels = 1;
};

/// Reads the frame header with libjpeg; nothing if the bytes up to the first scan are not a valid JPEG.
std::optional<JpegFrame> read_jpeg_frame(std::span<const std::uint8_t> bytes);

/// A decoded JPEG.
struct JpegImage {
  Rgba8Image pixels;
  std::string flaw;  ///< the first damage that libjpeg found and decoded past, after the name; empty if there is none
};

/// Of a damaged file what libjpeg decodes is kept; pixels that are missing are grey.
///
/// Errors    ErrorKind::Input with `name` in front: not a JPEG, no data of its pixels, a corrupt header, more than
///           `max_pixels` pixels.
JpegImage decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name,
                      std::uint64_t max_pixels = std::uint64_t{1} << 28);

}  // namespace zoneplate
