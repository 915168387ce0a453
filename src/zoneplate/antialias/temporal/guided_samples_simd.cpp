// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/guided_samples.h"

#include "zoneplate/antialias/temporal/guided_samples_lanes.h"
#include "zoneplate/math/lanes_simd.h"

namespace zoneplate {
template <>
const antialias::GuidedKernels PerIsa<antialias::GuidedKernels>::HWY_NAMESPACE =
    stages::guided_samples<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
