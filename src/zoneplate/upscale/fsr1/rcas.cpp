// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr1/rcas.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/fsr1/rcas_lanes.h"

namespace zoneplate {

template <>
const RcasKernels PerIsa<RcasKernels>::scalar = stages::rcas<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
