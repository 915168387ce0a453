// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/evaluate.h"

#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/sdf/evaluate_lanes.h"

namespace zoneplate {
template <>
const sdf::CoverageKernels PerIsa<sdf::CoverageKernels>::HWY_NAMESPACE =
    sdf::stages::coverage_kernels<HWY_NAMESPACE::Float>();
}  // namespace zoneplate
