// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/fsr2/accumulate_lanes.h"

namespace zoneplate {
template <>
const Fsr2AccumulateKernels PerIsa<Fsr2AccumulateKernels>::HWY_NAMESPACE =
    stages::fsr2_accumulate<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
