// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/taau/sample_mean_rows_lanes.h"

namespace zoneplate {
template <>
const SampleMeanKernels PerIsa<SampleMeanKernels>::HWY_NAMESPACE =
    stages::sample_mean_rows<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
