// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// libjpeg's quality of files for which no other one is chosen, 1 to 100.
inline constexpr int default_jpeg_quality = 92;

/// A JPEG file without chroma subsampling, with an ICC profile unless that is empty; alpha is omitted.
///
/// Exact     the integer transform: the same bytes with the same version of libjpeg.
/// Errors    ErrorKind::Failed: sides above 65500 pixels.
std::vector<std::uint8_t> encode_jpeg(const Rgba8Image& image, int quality = default_jpeg_quality,
                                      std::span<const std::uint8_t> icc = {});

}  // namespace zoneplate
