// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/smaa/exact_areas.h"

#include "zoneplate/antialias/post/smaa/exact_areas_lanes.h"
#include "zoneplate/math/lanes_simd.h"

namespace zoneplate {

template <>
const AreaKernels PerIsa<AreaKernels>::HWY_NAMESPACE =
    stages::exact_areas<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();

}  // namespace zoneplate
