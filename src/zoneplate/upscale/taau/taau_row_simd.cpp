// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/taau/taau_row_lanes.h"

namespace zoneplate {
template <>
const TaauKernels PerIsa<TaauKernels>::HWY_NAMESPACE =
    stages::taau_rows<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
