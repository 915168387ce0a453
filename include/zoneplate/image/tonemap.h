// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The curve that maps unbounded linear colour to the range of a display.
enum class ToneMapping {
  None,     ///< clamped to [0, 1]
  Aces,     ///< Stephen Hill's fit of the ACES RRT and ODT, of color / 0.6, as three.js does it
  Neutral,  ///< Khronos PBR Neutral
  Agx,      ///< Troy Sobotka's AgX with its base look, as three.js does it
  Filmic,   ///< John Hable's curve of Uncharted 2, of 2 × color, with white at 11.2
};

/// Maps one linear colour (not premultiplied) to linear display light in [0, 1].
///
/// Edges     negative values and NaN count as 0, values above 2^24 as 2^24.
float3 tone_map(float3 color, ToneMapping mapping);

/// The colour that the Neutral curve maps to `mapped`. Each channel of `mapped` counts as at most 1 - 2^-20.
///
/// Source    Khronos Group, PBR Neutral Tone Mapper specification, "Inverse".
float3 invert_neutral(float3 mapped);

/// The default background: dark grey, as in F3D.
inline constexpr float4 default_background{0.2f, 0.2f, 0.2f, 1};

/// How a scene-linear image becomes display-referred.
struct DisplayOptions {
  ToneMapping mapping = ToneMapping::None;  ///< applied after the exposure
  float exposure = 1;                       ///< multiplies linear colour first
  bool is_transparent = false;              ///< keep alpha instead of compositing over the background
  float4 background{0, 0, 0, 1};            ///< sRGB-encoded, straight alpha; not tone-mapped
  bool raw = false;                         ///< no tone mapping and no sRGB encoding (--color-management raw)
};

/// The display-referred image: straight colour × exposure is tone-mapped, composited over the background in linear
/// light, and encoded. A transparent image is (0, 0, 0, 0) where alpha is 0.
///
/// Edges     every channel of the result is in [0, 1], for any input; where alpha is 0 the result is exactly the
///           background, where the image is opaque it does not depend on the background.
DisplayImage make_display(const LinearImage& image, const DisplayOptions& options);

/// quantize8(make_display(image, options)), without the image between them.
Rgba8Image make_display8(const LinearImage& image, const DisplayOptions& options);

/// Linear light × exposure over the background, premultiplied, without tone mapping. A transparent image has no
/// background.
LinearImage over_background(LinearImage image, const DisplayOptions& options);

}  // namespace zoneplate
#pragma GCC visibility pop
