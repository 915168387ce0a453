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

/// Encodes a portable float map: RGB floats, little-endian, rows from the bottom up; alpha is omitted.
std::vector<std::uint8_t> encode_pfm(const LinearImage& image);
/// Encodes a grey portable float map, one float per pixel.
std::vector<std::uint8_t> encode_pfm(const Plane<float>& image);

/// True for the first bytes of a portable float map.
bool is_pfm(std::span<const std::uint8_t> bytes);

/// Width and height as the header states them; nothing for other bytes.
std::optional<int2> find_pfm_size(std::span<const std::uint8_t> bytes);

/// Decodes a portable float map, colour ("PF") or grey ("Pf"), in either byte order.
///
/// Units     as stored: the sign of the header's scale is the byte order, and its magnitude is ignored. Values that are
///           not finite are kept. Alpha is 1; grey gives equal red, green and blue.
/// Errors    ErrorKind::Input with `name` in front: not a portable float map, another number of bytes than the header
///           states, more than `max_pixels` pixels.
/// Source    Debevec, PFM Portable FloatMap Image Format, 2001.
LinearImage decode_pfm(std::span<const std::uint8_t> bytes, const std::string& name,
                       std::uint64_t max_pixels = std::uint64_t{1} << 28);

}  // namespace zoneplate
