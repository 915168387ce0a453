// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/shading.h"

#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/shade/surface/shading_lanes.h"

namespace zoneplate {
template <>
const SurfaceKernels PerIsa<SurfaceKernels>::HWY_NAMESPACE =
    stages::all<HWY_NAMESPACE::Float, HWY_NAMESPACE::WideFloat>();
}  // namespace zoneplate
