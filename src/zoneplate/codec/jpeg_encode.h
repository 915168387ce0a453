// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// A JPEG file of quality 92 without chroma subsampling; alpha is omitted.
///
/// Exact     the integer transform: the same bytes with the same version of libjpeg.
/// Errors    ErrorKind::Failed: sides above 65500 pixels.
std::vector<std::uint8_t> encode_jpeg(const Rgba8Image& image);

}  // namespace zoneplate
