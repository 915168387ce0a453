// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// True for the first bytes of a WebP file.
bool is_webp(std::span<const std::uint8_t> bytes);

/// Width and height as the header of a WebP file states them.
std::optional<int2> find_webp_size(std::span<const std::uint8_t> bytes);

/// Decodes a WebP image.
///
/// Errors    ErrorKind::Input with `name` in front: corrupt, animated, more than `max_pixels`.
Rgba8Image decode_webp(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

/// Encodes a WebP file: lossless, including the colours of transparent pixels, or of a quality from 0 to 100 with
/// chroma subsampling. Without `has_alpha`, alpha is not written; with it, alpha is lossless. An ICC profile is written
/// unless it is empty.
///
/// Exact     the same bytes with the same version of libwebp.
/// Errors    ErrorKind::Failed: sides above 16383 pixels.
std::vector<std::uint8_t> encode_webp(const Rgba8Image& image, bool has_alpha,
                                      std::optional<int> quality = std::nullopt,
                                      std::span<const std::uint8_t> icc = {});

}  // namespace zoneplate
