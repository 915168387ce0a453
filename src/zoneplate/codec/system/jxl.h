// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/codec/system/stored_image.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// True for the first bytes of a JPEG XL codestream or container.
bool is_jxl(std::span<const std::uint8_t> bytes);

/// Width and height that the codestream states, before its orientation.
std::optional<int2> find_jxl_size(std::span<const std::uint8_t> bytes);

/// Whether the header of a JPEG XL file states an animation.
bool is_animated_jxl(std::span<const std::uint8_t> bytes);

/// Decodes a JPEG XL image, or the first frame of an animation, by libjxl.
///
/// Units     codes of 8 bits, or of more bits widened to 16; linear floats are scene-linear light, and others codes of 16
///           bits. What is stored in the format's own colour space (XYB) becomes sRGB, or light if it has floats; other
///           codes are as stored.
/// Errors    ErrorKind::Input with `name` in front: corrupt, truncated, light of other primaries than Rec.709, more than
///           `max_pixels` pixels; libjxl is not installed. LibraryNeeded.
StoredImage decode_jxl(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

/// Encodes a JPEG XL file, lossless, by libjxl. Without `has_alpha`, alpha is not written.
///
/// Exact     the same bytes with the same version of the library.
/// Errors    ErrorKind::Input: libjxl is not installed; ErrorKind::Failed. LibraryNeeded.
std::vector<std::uint8_t> encode_jxl(const Rgba8Image& image, bool has_alpha);

}  // namespace zoneplate
