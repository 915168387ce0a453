// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/lookup.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/environment/lookup_lanes.h"

namespace zoneplate {

template <>
const LookupKernels PerIsa<LookupKernels>::scalar = {
    {}, &stages::specular_lights<scalar::Float>, &stages::mix_levels<scalar::Float>};

}  // namespace zoneplate
