#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// Display codes as 8 bits with noise in place of steps: floor(255 x + u), u in [0, 1) from a hash of pixel and
/// channel.
///
/// The mean over many pixels is the value itself, where rounding would make bands of it. What an 8-bit code can say
/// exactly, 0 and 1 among it, has no noise; nor has alpha.
/// Exact     integers decide u: the same bits everywhere.
Rgba8Image quantize8_dithered(const DisplayImage& image);

}  // namespace zoneplate
