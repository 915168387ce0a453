// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr2/accumulate.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/fsr2/accumulate_lanes.h"

namespace zoneplate {

template <>
const Fsr2AccumulateKernels PerIsa<Fsr2AccumulateKernels>::scalar =
    stages::fsr2_accumulate<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
