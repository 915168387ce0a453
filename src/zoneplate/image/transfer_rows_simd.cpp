// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/transfer_rows.h"

#include "zoneplate/image/transfer_lanes.h"
#include "zoneplate/math/lanes_simd.h"

namespace zoneplate {
template <>
const TransferKernels PerIsa<TransferKernels>::HWY_NAMESPACE =
    stages::transfer_rows<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();
}  // namespace zoneplate
