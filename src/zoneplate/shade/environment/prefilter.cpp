// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/prefilter.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/environment/prefilter_lanes.h"

namespace zoneplate {

template <>
const PrefilterKernels PerIsa<PrefilterKernels>::scalar = {{}, &stages::filter<scalar::Float>};

}  // namespace zoneplate
