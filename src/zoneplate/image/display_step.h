// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"
#include "zoneplate/image/pixel.h"
#include "zoneplate/image/tonemap.h"

namespace zoneplate {

/// The parameters of the display transform of a pixel, with the background converted.
struct DisplayStep {
  ToneMapping mapping = ToneMapping::None;  ///< None for raw output
  float exposure = 1;
  bool is_encoded = true;
  bool is_transparent = false;
  float code[4] = {0, 0, 0, 1};   ///< the background, encoded, straight alpha; all 0 if its alpha is 0
  float light[4] = {0, 0, 0, 1};  ///< the background in linear light, premultiplied
};

struct TonemapKernels : PerIsa<TonemapKernels> {
  /// n pixels of four floats: Linear in, Display out.
  void (*display_row)(const DisplayStep& step, const float* linear, float* display, std::size_t n);
  /// Applies display_row and quantize8 to n groups of eight pixels.
  void (*show_groups)(const DisplayStep& step, const Linear8* linear, Rgba8* shown, std::size_t n);
  /// DisplayTransform::is_decided for a step without tone mapping over an opaque background.
  bool (*is_decided)(const DisplayStep& step, const Linear8& front, float brightest, float rounding);
};

}  // namespace zoneplate
