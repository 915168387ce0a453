// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/table/table_rows.h"

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/table/table_rows_lanes.h"

namespace zoneplate {

template <>
const TableKernels PerIsa<TableKernels>::scalar = stages::table_rows<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
