// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/guided_samples.h"

#include "zoneplate/antialias/temporal/guided_samples_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {

template <>
const antialias::GuidedKernels PerIsa<antialias::GuidedKernels>::scalar =
    stages::guided_samples<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
