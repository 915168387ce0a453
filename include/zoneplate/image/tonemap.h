#pragma once

#include "zoneplate/base/api.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace ZONEPLATE_API zoneplate {

/// The curve that maps unbounded linear colour to the range of a display.
enum class ToneMapping {
  None,     ///< clamped to [0, 1]
  Aces,     ///< Stephen Hill's fit of the ACES RRT and ODT, of color / 0.6, as three.js does it
  Neutral,  ///< Khronos PBR Neutral
};

/// Maps one linear colour (not premultiplied) to linear display light in [0, 1].
///
/// Edges     what is negative or not a number counts as 0, what is above 2^24 as 2^24.
float3 tone_map(float3 color, ToneMapping mapping);

/// The background of pictures unless another one is given: dark grey, as F3D has it.
inline constexpr float4 default_background{0.2f, 0.2f, 0.2f, 1};

/// How a scene-linear image becomes display-referred.
struct DisplayOptions {
  ToneMapping mapping = ToneMapping::None;  ///< applied after the exposure
  float exposure = 1;                       ///< multiplies linear colour first
  bool is_transparent = false;              ///< keep alpha; else the background shows through
  float4 background{0, 0, 0, 1};            ///< sRGB code, straight alpha; shown as it is, not tone mapped
  bool raw = false;                         ///< no tone mapping and no sRGB encoding (--color-management raw)
};

/// The picture as it is shown: straight colour × exposure is tone mapped, laid over the background in linear
/// light, and encoded. Where alpha is 0 a transparent picture holds (0, 0, 0, 0).
///
/// Edges     every channel of the result is in [0, 1], whatever the picture holds; where alpha is 0 the
///           background's own code is shown, where the picture is opaque nothing of it.
DisplayImage make_display(const LinearImage& image, const DisplayOptions& options);

/// Linear light × exposure over the background, premultiplied: the picture before tone mapping. A transparent picture
/// stays without background.
LinearImage over_background(LinearImage image, const DisplayOptions& options);

}  // namespace zoneplate
