// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

struct DdaaOptions {
  float threshold = 0.166f;  ///< minimum contrast, relative to the greatest luma around
  float least = 0.0625f;     ///< absolute minimum contrast
  float strength = 3;        ///< of the blur along edges
};

/// Directional diffusion antialiasing of an sRGB-encoded image; `memory` may be any image, whose storage is reused.
///
/// Space     encoded values are blended; luma is √(0.299 R + 0.587 G + 0.114 B) of encoded values in [0, 1], as in the
///           original.
/// Edges     the outermost pixels are repeated beyond the sides.
/// Source    Klein, DDAA 2.4, 2025 (almarklein/ppaa-experiments).
Rgba8Image apply_ddaa(const Rgba8Image& image, const DdaaOptions& options, Rgba8Image memory = {});

}  // namespace zoneplate::antialias
