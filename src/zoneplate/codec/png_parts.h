#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/codec/png.h"

namespace zoneplate {

/// Writes a picture of 8 bits a channel as PNG, quickly: filter Up, runs of one byte, in parts that are made in
/// parallel.
///
/// Shape     one IDAT chunk for some 128 KiB of rows.
/// Exact     the same bytes for any number of threads: a part's rows depend on the picture's width alone.
/// Requires  options.text is empty; of the options only has_alpha and is_srgb say anything.
std::vector<std::uint8_t> encode_png_parts(const Rgba8Image& image, const PngOptions& options);

}  // namespace zoneplate
