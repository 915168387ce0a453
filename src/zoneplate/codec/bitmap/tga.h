// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// True for bytes that begin with a valid header of a Truevision TGA. The format has no signature at its start, so that
/// others are recognised first.
bool is_tga(std::span<const std::uint8_t> bytes);

/// Width and height; nothing if the bytes are no TGA.
std::optional<int2> find_tga_size(std::span<const std::uint8_t> bytes);

/// Decodes colour-mapped, true-colour and grey images (types 1, 2, 3 and, run-length encoded, 9, 10, 11) of any origin,
/// with 8 bits per grey value or index and 15, 16, 24 or 32 bits per colour. Alpha is the fourth byte of 32 bits, the
/// second of a grey value of 16, and the highest bit of 16 bits if the header states such a bit; where it would hide
/// all pixels, the image is opaque.
///
/// Errors    ErrorKind::Input with `name` in front: not a TGA, truncated, corrupt, more than `max_pixels` pixels.
/// Source    Truevision TGA File Format Specification, version 2.0, 1991.
Rgba8Image decode_tga(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

}  // namespace zoneplate
