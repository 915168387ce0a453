// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/shading.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/surface/shading_lanes.h"

namespace zoneplate {

template <>
const SurfaceKernels PerIsa<SurfaceKernels>::scalar = stages::all<scalar::Float, scalar::WideFloat>();

}  // namespace zoneplate
