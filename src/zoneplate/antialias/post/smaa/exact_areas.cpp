// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/smaa/exact_areas.h"

#include "zoneplate/antialias/post/smaa/exact_areas_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {

template <>
const AreaKernels PerIsa<AreaKernels>::scalar = stages::exact_areas<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
