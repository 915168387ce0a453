#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

/// Directionally localized antialiasing of a picture of codes; `memory` may be any picture, whose storage is reused.
///
/// Space     codes are mixed, as in the original; luma is their mean.
/// Edges     beyond the sides the outermost pixels go on; a division by zero gives the pixel's own colour.
/// Source    Andreev, Directionally Localized Anti-Aliasing, GDC 2011: with its first pass, which many ports leave out.
Rgba8Image apply_dlaa(const Rgba8Image& image, Rgba8Image memory = {});

}  // namespace zoneplate::antialias
