#pragma once

#include "zoneplate/base/api.h"
#include "zoneplate/image/pixel.h"
#include "zoneplate/image/plane.h"

namespace ZONEPLATE_API zoneplate {

using LinearImage = Plane<Linear>;
using DisplayImage = Plane<Display>;
using Rgba8Image = Plane<Rgba8>;
using Rgba16Image = Plane<Rgba16>;

}  // namespace zoneplate
