// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/sgsr/sgsr2_rows.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/sgsr/sgsr2_rows_lanes.h"

namespace zoneplate {

template <>
const Sgsr2Kernels PerIsa<Sgsr2Kernels>::scalar = stages::sgsr2_rows<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
