// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/fsr1/rcas_lanes.h"

namespace zoneplate {
template <>
const RcasKernels PerIsa<RcasKernels>::HWY_NAMESPACE = stages::rcas<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
