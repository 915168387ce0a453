// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/learned/learned_rows.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/learned/learned_rows_lanes.h"

namespace zoneplate {

template <>
const LearnedKernels PerIsa<LearnedKernels>::scalar = stages::learned_rows<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
