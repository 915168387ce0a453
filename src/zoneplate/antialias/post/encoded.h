// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <functional>

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

/// The values that a method blends; transparent images are premultiplied in the same values.
enum class Mixing {
  Encoded,  ///< sRGB-encoded values
  Linear,   ///< linear light
};

using EncodedFilter = std::function<Rgba8Image(const Rgba8Image&)>;

/// Applies a filter that is defined on sRGB-encoded 8-bit images to a display-referred image.
///
/// Edges     a transparent image is premultiplied and filtered over black and over white, colour and alpha together, so
///           that silhouettes of every colour are detected; straight colours stay within those around each pixel.
/// Exact     a pixel whose 8-bit values the filter does not change keeps its bits; any other of an opaque image becomes
///           value / 255.
DisplayImage filter_encoded(DisplayImage image, Mixing mixing, const EncodedFilter& filter);

/// The display-referred pixels a and b, premultiplied and weighted by 1 - weight and weight.
Display mixed(const Display& a, const Display& b, float weight, Mixing mixing);

/// `v` rounded to an integer, for v in [0, 255].
inline std::uint8_t round_unorm8(float v) { return static_cast<std::uint8_t>(v + 0.5f); }

/// value / 255 for each 8-bit value, as a table.
inline constexpr std::array<float, 256> unorm8_value = [] {
  std::array<float, 256> out{};
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(i) / 255;
  return out;
}();

/// Converts a pixel between sRGB-encoded values and linear light with alpha in [0, 1].
Linear decode_pixel(Rgba8 codes);
Rgba8 encode_pixel(Linear light);

/// The pixel (1 - t) a + t b, computed in linear light.
Rgba8 mix_linear(Rgba8 a, Rgba8 b, float t);

/// Rows of one block of work, independently of the number of threads.
inline constexpr std::size_t rows_a_block = 16;

/// Calls `body(y)` for every row of an image, in parallel for blocks of rows.
void for_rows(int height, const std::function<void(int)>& body);

/// Copies row y of an image into another one of its size. (std::ranges::copy takes one pixel at a time.)
inline void copy_row(const Rgba8Image& from, Rgba8Image& to, int y) {
  std::memcpy(to.row(y).data(), from.row(y).data(), from.row(y).size_bytes());
}

/// Returns `memory` if it has the size of `like`, with its previous values; else a new image of that size, which is
/// zero.
Rgba8Image sized_like(const Rgba8Image& like, Rgba8Image memory);

}  // namespace zoneplate::antialias
