// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/elementary_rows.h"

#include "zoneplate/math/elementary_lanes.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {

template <>
const ElementaryKernels PerIsa<ElementaryKernels>::scalar = stages::elementary_rows<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
