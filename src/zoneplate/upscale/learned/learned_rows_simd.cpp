// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/learned/learned_rows_lanes.h"

namespace zoneplate {
template <>
const LearnedKernels PerIsa<LearnedKernels>::HWY_NAMESPACE =
    stages::learned_rows<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
