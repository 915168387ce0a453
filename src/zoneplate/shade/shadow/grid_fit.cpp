// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/grid_fit.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/shadow/grid_fit_lanes.h"

namespace zoneplate {

template <>
const GridFitKernels PerIsa<GridFitKernels>::scalar = {.fit = &stages::fit<scalar::Float>};

}  // namespace zoneplate
