#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

struct DdaaOptions {
  float threshold = 0.166f;  ///< least contrast, as a share of the brightest luma around
  float least = 0.0625f;     ///< least contrast at all
  float strength = 3;        ///< of the blur along edges
};

/// Directional diffusion antialiasing of a picture of codes; `memory` may be any picture, whose storage is reused.
///
/// Space     codes are mixed; luma is √(0.299 R + 0.587 G + 0.114 B) of codes in [0, 1], as in the original.
/// Edges     beyond the sides the outermost pixels go on.
/// Source    Klein, DDAA 2.4, 2025 (almarklein/ppaa-experiments).
Rgba8Image apply_ddaa(const Rgba8Image& image, const DdaaOptions& options, Rgba8Image memory = {});

}  // namespace zoneplate::antialias
