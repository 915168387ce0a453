// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/geometric/bilateral.h"

#include "zoneplate/antialias/geometric/bilateral_lanes.h"
#include "zoneplate/math/lanes_simd.h"

namespace zoneplate {
template <>
const SraaKernels PerIsa<SraaKernels>::HWY_NAMESPACE =
    stages::bilateral<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
