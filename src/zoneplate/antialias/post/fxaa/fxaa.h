#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

struct FxaaOptions {
  static constexpr int console = 0;

  int preset = 12;             ///< 10 to 15, 20 to 29, 39 of the quality path, or `console`
  double threshold = 0.166;    ///< least contrast, as a share of the brightest luma around
  double least = 0.0833;       ///< least contrast, in code / 255
  float subpixel = 0.75f;      ///< how much a pixel unlike all its neighbours is taken towards them (quality)
  float sharpness = 8;         ///< of edges (console)
  bool is_green_luma = false;  ///< luma is the green code, not 0.299 R + 0.587 G + 0.114 B
  bool mixes_light = false;    ///< mix linear light instead of codes (quality)
};

/// FXAA 3.11 of a picture of codes; `memory` may be any picture, whose storage is reused where its size fits.
///
/// Space     luma is held in 8 bits, as in the alpha channel where the original wants it.
/// Edges     beyond the sides the outermost pixels go on.
/// Exact     directions and sides are chosen by integers: of equal ones the horizontal direction, the upper or left
///           side.
/// Cost      the pixels without contrast are passed over by vectors.
Rgba8Image apply_fxaa(const Rgba8Image& image, const FxaaOptions& options, Rgba8Image memory = {});

/// How far away a pixel can be that decides another one.
int fxaa_reach(const FxaaOptions& options);

}  // namespace zoneplate::antialias
