#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Width and height as the header of a PNG, JPEG, WebP, HDR or EXR states them; nothing for other bytes.
std::optional<int2> find_image_size(std::span<const std::uint8_t> bytes);

/// Bytes that decoding takes beside the picture, at most.
std::uint64_t image_working_memory(std::span<const std::uint8_t> bytes);

/// Decodes the image of a texture, PNG, JPEG, WebP, HDR or EXR by its first bytes, whatever its name says; 16 bits are
/// rounded to 8, light becomes its sRGB code: what is brighter than white is white.
///
/// An EXR may have a quarter of the pixels, for each takes four times the room on the way.
/// Errors    Trouble::Input with `name` in front: another format (named, if known), corrupt, more than `max_pixels`.
Rgba8Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

}  // namespace zoneplate
