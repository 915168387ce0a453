// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/fsr1/easu.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/fsr1/easu_lanes.h"

namespace zoneplate {

template <>
const EasuKernels PerIsa<EasuKernels>::scalar = stages::easu<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
