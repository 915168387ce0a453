#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/base/api.h"
#include "zoneplate/image/rgb.h"

namespace ZONEPLATE_API zoneplate {

///@{
/// The sRGB transfer curve (IEC 61966-2-1) between linear light and code.
///
/// Edges     arguments are clamped to [0, 1], 0 where they are not numbers; 0 and 1 are kept.
/// Exact     computed with + - × / only, so the same bits everywhere; within 1e-6 of the definition.
float encode_srgb(float linear);
float decode_srgb(float code);
///@}

/// The curve's value for code / 255, rounded to float.
float decode_srgb8(std::uint8_t code);

/// The same for every code / 65535.
std::vector<float> decoded_srgb16();

/// The 8-bit code of a linear value: the definition's curve times 255, exactly rounded.
///
/// Edges     as encode_srgb.
/// Exact     from the definition's own thresholds, so that it rises with `linear`; within rounding of a threshold
///           quantize8 of encode_srgb may differ by one.
std::uint8_t encode_srgb8(float linear);

///@{
/// Display codes rounded to 8 and 16 bits: floor(255 x + 0.5), floor(65535 x + 0.5) on values clamped to [0, 1].
Rgba8Image quantize8(const DisplayImage& image);
Rgba16Image quantize16(const DisplayImage& image);
///@}

}  // namespace zoneplate
