// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// True for the first bytes of a Windows bitmap.
bool is_bmp(std::span<const std::uint8_t> bytes);

/// Width and height as the header states them; nothing if it is invalid.
std::optional<int2> find_bmp_size(std::span<const std::uint8_t> bytes);

/// Decodes 1, 4, 8, 16, 24 or 32 bits per pixel with a header of 12 (OS/2) or 40 to 124 bytes, uncompressed, with bit
/// fields, RLE4 or RLE8. Pixels that the run lengths leave out have the first colour of the palette. Alpha is that of
/// an alpha mask alone, as in browsers; where it would hide all pixels, the image is opaque.
///
/// Errors    ErrorKind::Input with `name` in front: not a BMP, another compression, truncated, corrupt, more than
///           `max_pixels` pixels.
/// Source    BITMAPFILEHEADER to BITMAPV5HEADER and Bitmap Compression, Windows GDI reference.
Rgba8Image decode_bmp(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

}  // namespace zoneplate
