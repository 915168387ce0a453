// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/nis/directional_lanes.h"

namespace zoneplate {
template <>
const NisKernels PerIsa<NisKernels>::HWY_NAMESPACE = stages::nis<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
