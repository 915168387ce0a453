// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// Depths as greys of 16 bits: 0 is the nearest and 65534 the farthest visible distance, linear between; 65535 is
/// empty.
struct DepthCodes {
  Plane<std::uint16_t> image;
  float near = 0, far = 0;  ///< near > far: nothing is visible
};
DepthCodes depth_codes(const Plane<float>& depth);

/// A hue of the colour circle, from red (0) over green (1/3) and blue (2/3) to red (1), blended with white.
Rgba8 circle_color(float turn, float saturation);

/// White where the texture is magnified by two or more, then once around the colour circle in eight levels; transparent
/// without a texture.
Rgba8 mip_level_color(float level);

/// By the logarithm of the footprint's length over its width: black for 1, pale yellow for 16; transparent without a
/// texture.
Rgba8 anisotropy_color(float ratio);

}  // namespace zoneplate
