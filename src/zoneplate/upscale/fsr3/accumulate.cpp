// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr3/accumulate.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/fsr3/accumulate_lanes.h"

namespace zoneplate {

template <>
const Fsr3AccumulateKernels PerIsa<Fsr3AccumulateKernels>::scalar =
    stages::fsr3_accumulate<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
