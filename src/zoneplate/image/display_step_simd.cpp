// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/display_step.h"

#include "zoneplate/image/display_step_lanes.h"
#include "zoneplate/math/lanes_simd.h"

namespace zoneplate {
template <>
const TonemapKernels PerIsa<TonemapKernels>::HWY_NAMESPACE =
    stages::display_step<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
