// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/sgsr/sgsr2_rows_lanes.h"

namespace zoneplate {
template <>
const Sgsr2Kernels PerIsa<Sgsr2Kernels>::HWY_NAMESPACE =
    stages::sgsr2_rows<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
