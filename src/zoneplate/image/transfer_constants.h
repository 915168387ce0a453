#pragma once

/// The constants of the sRGB curve, IEC 61966-2-1: a line below the cutoff, an offset power above it.
namespace zoneplate::srgb {

inline constexpr float linear_cutoff = 0.0031308f;
inline constexpr float code_cutoff = 0.04045f;
inline constexpr float slope = 12.92f;
inline constexpr float scale = 1.055f;
inline constexpr float offset = scale - 1;  // exact, so that 1 is kept
inline constexpr float power = 2.4f;
inline constexpr float inverse_power = 1 / 2.4f;

}  // namespace zoneplate::srgb
