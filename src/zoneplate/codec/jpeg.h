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

/// What the frame header of a JPEG states.
struct JpegFrame {
  int2 size;
  std::uint64_t samples = 0;  ///< of all components in one unit of `pixels`: 3 of 2 where colour is stored by halves
  std::uint64_t pixels = 1;
};

/// The frame header, as read by libjpeg; nothing if the bytes up to the first scan are not a valid JPEG.
std::optional<JpegFrame> read_jpeg_frame(std::span<const std::uint8_t> bytes);

/// Errors    ErrorKind::Input with `name` in front: not a JPEG, truncated, corrupt, more than `max_pixels` pixels.
Rgba8Image decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name,
                       std::uint64_t max_pixels = std::uint64_t{1} << 28);

}  // namespace zoneplate
