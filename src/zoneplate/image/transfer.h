#pragma once

#include <cstdint>
#include <span>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// The sRGB transfer curve (IEC 61966-2-1) between linear light and code, both in [0, 1].
///
/// Exact     computed with + - × / √ only, so the same bits everywhere; within 1e-6 of the definition.
float encode_srgb(float linear);
float decode_srgb(float code);

/// decode_srgb(code / 255), rounded to float.
float decode_srgb8(std::uint8_t code);

/// The 8-bit code of a linear value, clamped to [0, 1]: round(255 encode_srgb(linear)), exactly that rounding.
std::uint8_t encode_srgb8(float linear);

/// Display codes rounded to 8 bits: floor(255 x + 0.5) on values clamped to [0, 1].
Rgba8Image quantize8(const DisplayImage& image);
Rgba16Image quantize16(const DisplayImage& image);

}  // namespace zoneplate
