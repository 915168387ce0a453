// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/sampling/accumulate.h"

#include "zoneplate/antialias/sampling/accumulate_lanes.h"
#include "zoneplate/math/lanes_simd.h"

namespace zoneplate {
template <>
const AccumulateKernels PerIsa<AccumulateKernels>::HWY_NAMESPACE = stages::accumulate<HWY_NAMESPACE::Float>();
}  // namespace zoneplate
