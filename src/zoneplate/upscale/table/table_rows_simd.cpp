// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/lanes_simd.h"
#include "zoneplate/upscale/table/table_rows_lanes.h"

namespace zoneplate {
template <>
const TableKernels PerIsa<TableKernels>::HWY_NAMESPACE =
    stages::table_rows<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
