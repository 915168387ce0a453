// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/learned/network_rows.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/learned/network_rows_lanes.h"

namespace zoneplate {

template <>
const NetworkKernels PerIsa<NetworkKernels>::scalar = stages::network_rows<scalar::Float>();

}  // namespace zoneplate
