// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/sgsr/edge_row.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/sgsr/edge_row_lanes.h"

namespace zoneplate {

template <>
const SgsrKernels PerIsa<SgsrKernels>::scalar = stages::sgsr<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
