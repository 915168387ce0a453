// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/resolve.h"

#include "zoneplate/antialias/temporal/resolve_lanes.h"
#include "zoneplate/math/lanes_simd.h"

namespace zoneplate {
template <>
const antialias::TemporalKernels PerIsa<antialias::TemporalKernels>::HWY_NAMESPACE =
    stages::temporal<HWY_NAMESPACE::WideFloat, HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
