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

/// The premultiplied colours of spans of eight pixels: the first span's r, g, b and a, each eight consecutive floats.
struct SpanColors {
  const float* channel[4];
  std::size_t stride;  ///< floats from a channel of one span to that of the next
};

struct TonemapKernels : PerIsa<TonemapKernels> {
  /// n pixels of four floats: Linear in, Display out.
  void (*display_row)(const DisplayStep& step, const float* linear, float* display, std::size_t n);
  /// Applies display_row and quantize8 to n spans of eight pixels, of which span i is stored from shown[i] on.
  void (*show_spans)(const DisplayStep& step, const SpanColors& linear, Rgba8* const* shown, std::size_t n);
  /// DisplayTransform::is_decided for a step without tone mapping over an opaque background.
  bool (*is_decided)(const DisplayStep& step, const Linear8& front, float brightest, float rounding);
};

}  // namespace zoneplate
