#pragma once

namespace zoneplate {

enum class ToneMapping {
  None,     ///< clamped to [0, 1]
  Aces,     ///< Stephen Hill's fit of the ACES RRT and ODT, of color / 0.6, as in three.js
  Neutral,  ///< Khronos PBR Neutral
};

/// The constants of the tone curves, shared by the scalar and the vector code.
namespace tone {

/// Radiance is clamped to this, which keeps every intermediate value finite.
inline constexpr float greatest = 0x1p24f;

/// Hill's fit: by rows, sRGB to the space of the curve and back, and the curve (v (v + a) - b) / (v (c v + d) + e).
/// Source: Stephen Hill, BakingLab, ACES.hlsl; the exposure of 1 / 0.6 is that of three.js.
inline constexpr float aces_exposure = 1 / 0.6f;
inline constexpr float aces_in[3][3] = {
    {0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, {0.02840f, 0.13383f, 0.83777f}};
inline constexpr float aces_out[3][3] = {
    {1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f}, {-0.00327f, -0.07276f, 1.07602f}};
inline constexpr float aces_a = 0.0245786f, aces_b = 0.000090537f;
inline constexpr float aces_c = 0.983729f, aces_d = 0.4329510f, aces_e = 0.238081f;

/// Source: Khronos Group, PBR Neutral Tone Mapper specification.
inline constexpr float neutral_f90 = 0.04f;
inline constexpr float neutral_start = 0.8f - neutral_f90;
inline constexpr float neutral_desaturation = 0.15f;

}  // namespace tone

}  // namespace zoneplate
