// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/codec/system/color_tags.h"
#include "zoneplate/codec/system/stored_image.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// True for the first bytes of a TIFF or BigTIFF file.
bool is_tiff(std::span<const std::uint8_t> bytes);

/// Width and height of the first image of a TIFF file, as stored, before its orientation.
std::optional<int2> find_tiff_size(std::span<const std::uint8_t> bytes);

/// The images of a TIFF file that are no reduced copies of another, at most 1,000,000.
std::size_t count_tiff_pages(std::span<const std::uint8_t> bytes);

/// The ICC profile of the first image of a TIFF file.
ColorTags find_tiff_colors(std::span<const std::uint8_t> bytes);

/// Decodes the first image of a TIFF file by libtiff: grey, palette and RGB of 1 to 16 bits, and half, float or double
/// light; with or without alpha, in strips or tiles, of any compression that libtiff has.
///
/// Units     codes as stored, widened to 8 bits; floats are scene-linear light. Associated alpha is divided out of codes.
///           Channels beside colour and alpha are left out.
/// Errors    ErrorKind::Input with `name` in front: corrupt, truncated, of another kind (named), more than `max_pixels`
///           pixels; libtiff is not installed. LibraryNeeded.
/// Source    TIFF 6.0, Adobe 1992; TIFF Technical Note 3 (floats).
StoredImage decode_tiff(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

}  // namespace zoneplate
