// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

/// Directionally localized antialiasing of an sRGB-encoded image; `memory` may be any image, whose storage is reused.
///
/// Space     encoded values are blended, as in the original; luma is the mean of the channels.
/// Edges     the outermost pixels are repeated beyond the sides; a division by zero gives the pixel's own colour.
/// Source    Andreev, Directionally Localized Anti-Aliasing, GDC 2011: with its first pass, which many ports omit.
Rgba8Image apply_dlaa(const Rgba8Image& image, Rgba8Image memory = {});

}  // namespace zoneplate::antialias
