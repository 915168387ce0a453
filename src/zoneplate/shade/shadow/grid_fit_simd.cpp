// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/grid_fit.h"

#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/shade/shadow/grid_fit_lanes.h"

namespace zoneplate {
template <>
const GridFitKernels PerIsa<GridFitKernels>::HWY_NAMESPACE = {.fit = &stages::fit<HWY_NAMESPACE::WideFloat>};
}  // namespace zoneplate
