// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/lookup.h"

#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/shade/environment/lookup_lanes.h"

namespace zoneplate {
template <>
const LookupKernels PerIsa<LookupKernels>::HWY_NAMESPACE = {
    {}, &stages::specular_lights<HWY_NAMESPACE::Float>, &stages::mix_levels<HWY_NAMESPACE::WideFloat>};
}  // namespace zoneplate
