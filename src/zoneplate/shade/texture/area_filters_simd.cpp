// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/shade/texture/area_filters.h"
#include "zoneplate/shade/texture/area_filters_lanes.h"

namespace zoneplate {
template <>
const AreaFilterKernels PerIsa<AreaFilterKernels>::HWY_NAMESPACE = area::all<HWY_NAMESPACE::Float>();
}  // namespace zoneplate
