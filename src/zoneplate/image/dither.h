// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// Quantizes display-referred values to 8 bits with dithering: floor(255 x + u), where u in [0, 1) is a hash of pixel
/// and channel.
///
/// The expected value is the value itself, which avoids the banding of rounding. Values that 8 bits represent exactly,
/// including 0 and 1, have no noise; nor has alpha.
/// Exact     u is computed with integers: the same bits everywhere.
Rgba8Image quantize8_dithered(const DisplayImage& image);

}  // namespace zoneplate
