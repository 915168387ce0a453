// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

struct FxaaOptions {
  static constexpr int console = 0;

  int preset = 12;             ///< 10 to 15, 20 to 29, 39 of the quality path, or `console`
  double threshold = 0.166;    ///< minimum contrast, relative to the greatest luma around
  double least = 0.0833;       ///< absolute minimum contrast, as encoded value / 255
  float subpixel = 0.75f;      ///< weight of sub-pixel smoothing (quality)
  float sharpness = 8;         ///< of edges (console)
  bool is_green_luma = false;  ///< luma is the encoded green, not 0.299 R + 0.587 G + 0.114 B
  bool mixes_light = false;    ///< blend linear light instead of encoded values (quality)
};

/// FXAA 3.11 of an sRGB-encoded image; `memory` may be any image, whose storage is reused if it has the same size.
///
/// Space     luma has 8 bits, as in the alpha channel from which the original reads it.
/// Edges     the outermost pixels are repeated beyond the sides.
/// Exact     directions and sides are chosen by integer comparisons; ties give the horizontal direction, and the upper
///           or left side.
/// Cost      pixels without contrast are skipped by whole vectors.
Rgba8Image apply_fxaa(const Rgba8Image& image, const FxaaOptions& options, Rgba8Image memory = {});

/// The greatest distance between a pixel and one that it affects.
int fxaa_radius(const FxaaOptions& options);

}  // namespace zoneplate::antialias
