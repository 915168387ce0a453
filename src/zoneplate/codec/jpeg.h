#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// Errors    ErrorKind::Input with `name` in front: not a JPEG, truncated, corrupt, more than `max_pixels` pixels.
Rgba8Image decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name,
                       std::uint64_t max_pixels = std::uint64_t{1} << 28);

}  // namespace zoneplate
