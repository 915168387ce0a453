// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/fsr1/easu_lanes.h"

namespace zoneplate {
template <>
const EasuKernels PerIsa<EasuKernels>::HWY_NAMESPACE = stages::easu<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
