// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// True for the first bytes of a Radiance image.
bool is_hdr(std::span<const std::uint8_t> bytes);

/// Width and height as the header states them.
std::optional<int2> find_hdr_size(std::span<const std::uint8_t> bytes);

/// Decodes a Radiance image (.hdr): RGBE pixels, uncompressed or with either run-length encoding, in any of the eight
/// scan orders.
///
/// Units     a channel is mantissa × 2^(exponent - 136), as stored: EXPOSURE lines are not undone. Alpha is 1.
/// Errors    ErrorKind::Input with `name` in front: not a Radiance image, in XYZE, truncated, corrupt, more than
///           `max_pixels` pixels.
/// Source    Ward, Real Pixels, Graphics Gems II, 1991; the Radiance file formats' reference.
LinearImage decode_hdr(std::span<const std::uint8_t> bytes, const std::string& name,
                       std::uint64_t max_pixels = std::uint64_t{1} << 28);

/// Decodes a Radiance image to red, green, blue and alpha as floats.
Plane<float4> decode_hdr_rgba(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

}  // namespace zoneplate
