// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/prefilter.h"

#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/shade/environment/prefilter_lanes.h"

namespace zoneplate {
template <>
const PrefilterKernels PerIsa<PrefilterKernels>::HWY_NAMESPACE = {{}, &stages::filter<HWY_NAMESPACE::WideFloat>};
}  // namespace zoneplate
