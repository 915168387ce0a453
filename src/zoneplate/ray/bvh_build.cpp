// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/ray/bvh_build.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/ray/bvh_build_lanes.h"

namespace zoneplate {

template <>
const BuildKernels PerIsa<BuildKernels>::scalar = stages::build_kernels<scalar::Float, scalar::Float>();

}  // namespace zoneplate
