// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/resolve.h"

#include "zoneplate/antialias/temporal/resolve_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {

template <>
const antialias::TemporalKernels PerIsa<antialias::TemporalKernels>::scalar =
    stages::temporal<scalar::WideFloat, scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
