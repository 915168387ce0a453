// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/elementary_rows.h"

#include "zoneplate/math/elementary_lanes.h"
#include "zoneplate/math/lanes_simd.h"

namespace zoneplate {

template <>
const ElementaryKernels PerIsa<ElementaryKernels>::HWY_NAMESPACE =
    stages::elementary_rows<HWY_NAMESPACE::Float, HWY_NAMESPACE::OneFloat>();

}  // namespace zoneplate
