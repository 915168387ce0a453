// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/learned/network_rows_lanes.h"

namespace zoneplate {
template <>
const NetworkKernels PerIsa<NetworkKernels>::HWY_NAMESPACE = stages::network_rows<HWY_NAMESPACE::Float>();
}  // namespace zoneplate
