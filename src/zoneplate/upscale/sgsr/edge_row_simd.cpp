// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/sgsr/edge_row_lanes.h"

namespace zoneplate {
template <>
const SgsrKernels PerIsa<SgsrKernels>::HWY_NAMESPACE = stages::sgsr<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
