// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/display_step.h"

#include "zoneplate/image/display_step_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {

template <>
const TonemapKernels PerIsa<TonemapKernels>::scalar =
    stages::display_step<scalar::Float, scalar::OneFloat, stages::NoPairs>();

}  // namespace zoneplate
