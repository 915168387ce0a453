// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/geometric/bilateral.h"

#include "zoneplate/antialias/geometric/bilateral_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {

template <>
const SraaKernels PerIsa<SraaKernels>::scalar = stages::bilateral<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
