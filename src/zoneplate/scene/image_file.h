#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Width and height as the header of a PNG, JPEG or WebP states them; nothing for other bytes.
std::optional<int2> find_image_size(std::span<const std::uint8_t> bytes);

/// Decodes the image of a texture, PNG, JPEG or WebP by its first bytes, whatever its name says; 16 bits are rounded
/// to 8.
///
/// Errors    Trouble::Input with `name` in front: another format (named, if known), corrupt, more than `max_pixels`.
Rgba8Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

}  // namespace zoneplate
