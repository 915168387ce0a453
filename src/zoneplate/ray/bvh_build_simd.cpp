// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/ray/bvh_build.h"

#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/ray/bvh_build_lanes.h"

namespace zoneplate {
template <>
const BuildKernels PerIsa<BuildKernels>::HWY_NAMESPACE =
    stages::build_kernels<HWY_NAMESPACE::Float, HWY_NAMESPACE::FourFloats>();
}  // namespace zoneplate
