#pragma once

#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

enum class ToneMapping {
  None,     ///< clamped to [0, 1]
  Aces,     ///< Stephen Hill's fit of the ACES RRT and ODT, of color / 0.6, as three.js does it
  Neutral,  ///< Khronos PBR Neutral
};

/// Maps one linear colour (not premultiplied) to linear display light in [0, 1].
float3 tone_map(float3 color, ToneMapping mapping);

struct DisplayOptions {
  ToneMapping mapping = ToneMapping::None;
  float exposure = 1;             ///< multiplies linear colour first
  bool is_transparent = false;    ///< keep alpha; else the background shows through
  float4 background{0, 0, 0, 1};  ///< sRGB code, straight alpha; shown as it is, not tone mapped
  bool raw = false;               ///< no tone mapping and no sRGB encoding (--color-management raw)
};

/// The picture as it is shown: straight colour × exposure is tone mapped, laid over the background in linear
/// light, and encoded. Where alpha is 0 a transparent picture holds (0, 0, 0, 0).
DisplayImage make_display(const LinearImage& image, const DisplayOptions& options);

}  // namespace zoneplate
