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

/// True for the first bytes of an AVIF image or image sequence.
bool is_avif(std::span<const std::uint8_t> bytes);

/// The greatest width and height that an AVIF file states for an image: those of the whole, before its rotation, if it
/// is a grid.
std::optional<int2> find_avif_size(std::span<const std::uint8_t> bytes);

/// The frames of the longest track; 0 of an image without tracks.
std::size_t count_avif_frames(std::span<const std::uint8_t> bytes);

/// The first ICC profile and the first code points (nclx) in the properties of an AVIF file.
ColorTags find_avif_colors(std::span<const std::uint8_t> bytes);

/// Decodes an AVIF image, or the first of a sequence, by libavif.
///
/// Units     codes as stored: 8 bits, or 10 and 12 bits widened to 16. Associated alpha is divided out.
/// Errors    ErrorKind::Input with `name` in front: corrupt, truncated, more than `max_pixels` pixels; libavif is not
///           installed. LibraryNeeded.
StoredImage decode_avif(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

/// Encodes an AVIF file, lossless, by libavif and libaom. Without `has_alpha`, alpha is not written.
///
/// Exact     the same bytes with the same versions of the libraries.
/// Errors    ErrorKind::Input: libavif is not installed; ErrorKind::Failed with its reason. LibraryNeeded.
std::vector<std::uint8_t> encode_avif(const Rgba8Image& image, bool has_alpha);

}  // namespace zoneplate
