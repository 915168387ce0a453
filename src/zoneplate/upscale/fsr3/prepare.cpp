// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr3/prepare.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/fsr3/prepare_lanes.h"

namespace zoneplate {

template <>
const Fsr3PrepareKernels PerIsa<Fsr3PrepareKernels>::scalar = stages::fsr3_prepare<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
