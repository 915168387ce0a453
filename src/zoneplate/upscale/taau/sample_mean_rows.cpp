// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/taau/sample_mean_rows.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/taau/sample_mean_rows_lanes.h"

namespace zoneplate {

template <>
const SampleMeanKernels PerIsa<SampleMeanKernels>::scalar = stages::sample_mean_rows<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
