// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/codec/png.h"

namespace zoneplate {

/// Encodes an image of 8 bits per channel as PNG, optimized for speed: filter Up and runs of one byte, in parts that
/// are encoded in parallel.
///
/// Shape     one IDAT chunk per approximately 128 KiB of rows.
/// Exact     the same bytes for any number of threads: the rows of a part depend only on the image's width.
/// Requires  options.text is empty; of the options, only has_alpha and is_srgb have an effect.
std::vector<std::uint8_t> encode_png_parts(const Rgba8Image& image, const PngOptions& options);

}  // namespace zoneplate
