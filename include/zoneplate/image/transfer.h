// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/image/rgb.h"

#pragma GCC visibility push(default)
namespace zoneplate {

///@{
/// The sRGB transfer curve (IEC 61966-2-1) between linear light and encoded values.
///
/// Edges     arguments are clamped to [0, 1], NaN becomes 0; 0 and 1 are exact.
/// Exact     computed with + - × / only, so the same bits everywhere; within 1e-6 of the definition.
float encode_srgb(float linear);
float decode_srgb(float code);
///@}

/// The linear value of the encoded value / 255, rounded to float.
float decode_srgb8(std::uint8_t code);

/// The same for every encoded value / 65535.
std::vector<float> decoded_srgb16();

/// The 8-bit encoded value of a linear value: the definition's curve times 255, exactly rounded.
///
/// Edges     as encode_srgb.
/// Exact     from the definition's own thresholds, so that it rises with `linear`; within rounding of a threshold
///           quantize8 of encode_srgb may differ by one.
std::uint8_t encode_srgb8(float linear);

///@{
/// Display-referred values rounded to 8 and 16 bits: floor(255 x + 0.5), floor(65535 x + 0.5), clamped to [0, 1] first.
Rgba8Image quantize8(const DisplayImage& image);
Rgba16Image quantize16(const DisplayImage& image);
///@}

}  // namespace zoneplate
#pragma GCC visibility pop
