#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

struct Cmaa2Options {
  float threshold = 0.07f;  ///< least difference of luma; the presets: 0.15, 0.10, 0.07, 0.05
  bool is_sharp = false;    ///< the original's extra sharpness
};

/// CMAA2 of a picture of codes; `memory` may be any picture, whose storage is reused where its size fits.
///
/// Space     luma is 0.299 √R + 0.587 √G + 0.114 √B of linear light; light is mixed.
/// Edges     there are none at the sides; a pixel without a corner keeps its codes unless it lies on a Z.
/// Exact     what several shapes give to one pixel is added in the order of the shapes' rows and columns.
Rgba8Image apply_cmaa2(const Rgba8Image& image, const Cmaa2Options& options, Rgba8Image memory = {});

}  // namespace zoneplate::antialias
