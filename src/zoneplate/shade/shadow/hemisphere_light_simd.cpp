// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/hemisphere_light.h"

#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/shade/shadow/hemisphere_light_lanes.h"

namespace zoneplate {
template <>
const HemisphereKernels PerIsa<HemisphereKernels>::HWY_NAMESPACE =
    stages::hemisphere_kernels<HWY_NAMESPACE::WideFloat>();
}  // namespace zoneplate
