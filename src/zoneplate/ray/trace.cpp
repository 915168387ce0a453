// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/ray/trace.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/ray/trace_lanes.h"

namespace zoneplate {

template <>
const RayKernels PerIsa<RayKernels>::scalar = stages::ray_kernels<scalar::Float, scalar::Float>();

}  // namespace zoneplate
