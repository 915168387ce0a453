// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/transfer_rows.h"

#include "zoneplate/image/transfer_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {

template <>
const TransferKernels PerIsa<TransferKernels>::scalar = stages::transfer_rows<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
