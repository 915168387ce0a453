// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/fsr3/prepare_lanes.h"

namespace zoneplate {
template <>
const Fsr3PrepareKernels PerIsa<Fsr3PrepareKernels>::HWY_NAMESPACE =
    stages::fsr3_prepare<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
