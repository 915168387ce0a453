// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/pixel.h"
#include "zoneplate/image/plane.h"

#pragma GCC visibility push(default)
namespace zoneplate {

using LinearImage = Plane<Linear>;    ///< scene-linear, premultiplied alpha
using DisplayImage = Plane<Display>;  ///< display-referred sRGB values in [0, 1], straight alpha
using Rgba8Image = Plane<Rgba8>;      ///< 8-bit sRGB codes, straight alpha
using Rgba16Image = Plane<Rgba16>;    ///< 16-bit codes, straight alpha

}  // namespace zoneplate
#pragma GCC visibility pop
