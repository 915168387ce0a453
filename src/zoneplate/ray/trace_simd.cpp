// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/ray/trace.h"

#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/ray/trace_lanes.h"

namespace zoneplate {
template <>
const RayKernels PerIsa<RayKernels>::HWY_NAMESPACE =
    stages::ray_kernels<HWY_NAMESPACE::Float, HWY_NAMESPACE::FourFloats>();
}  // namespace zoneplate
