// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/taau/taau_row.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/taau/taau_row_lanes.h"

namespace zoneplate {

template <>
const TaauKernels PerIsa<TaauKernels>::scalar = stages::taau_rows<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
