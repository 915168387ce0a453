// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/evaluate.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/sdf/evaluate_lanes.h"

namespace zoneplate {

template <>
const sdf::CoverageKernels PerIsa<sdf::CoverageKernels>::scalar = sdf::stages::coverage_kernels<scalar::Float>();

}  // namespace zoneplate
