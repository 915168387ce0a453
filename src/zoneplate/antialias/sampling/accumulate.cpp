// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/sampling/accumulate.h"

#include "zoneplate/antialias/sampling/accumulate_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {

template <>
const AccumulateKernels PerIsa<AccumulateKernels>::scalar = stages::accumulate<scalar::Float>();

}  // namespace zoneplate
