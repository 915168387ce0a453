// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

struct Cmaa2Options {
  float threshold = 0.07f;  ///< minimum difference of luma at an edge; the presets: 0.15, 0.10, 0.07, 0.05
  bool is_sharp = false;    ///< the original's extra sharpness
};

/// CMAA2 of an sRGB-encoded image; `memory` may be any image, whose storage is reused if it has the same size.
///
/// Space     luma is 0.299 √R + 0.587 √G + 0.114 √B of linear light; pixels are blended in linear light.
/// Edges     the image's sides are not edges; a pixel without a corner is unchanged unless it is on a Z shape.
/// Exact     the contributions of several shapes to a pixel are added in the order of the shapes' rows and columns.
Rgba8Image apply_cmaa2(const Rgba8Image& image, const Cmaa2Options& options, Rgba8Image memory = {});

}  // namespace zoneplate::antialias
