// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/codec/png.h"

namespace zoneplate {

/// Writes an image of 8 bits per channel as PNG, quickly: filter Up, runs of one byte, in parts that are encoded in
/// parallel.
///
/// Shape     one IDAT chunk for some 128 KiB of rows.
/// Exact     the same bytes for any number of threads: a part's rows depend only on the image's width.
/// Requires  options.text is empty; only the options has_alpha and is_srgb apply.
std::vector<std::uint8_t> encode_png_parts(const Rgba8Image& image, const PngOptions& options);

}  // namespace zoneplate
