// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/hemisphere_light.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/shadow/hemisphere_light_lanes.h"

namespace zoneplate {

template <>
const HemisphereKernels PerIsa<HemisphereKernels>::scalar = stages::hemisphere_kernels<scalar::Float>();

}  // namespace zoneplate
