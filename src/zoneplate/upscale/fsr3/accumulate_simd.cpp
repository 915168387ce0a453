// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/fsr3/accumulate_lanes.h"

namespace zoneplate {
template <>
const Fsr3AccumulateKernels PerIsa<Fsr3AccumulateKernels>::HWY_NAMESPACE =
    stages::fsr3_accumulate<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
