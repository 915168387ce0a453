// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Copies a vector to an array, which kernels read.
inline void copy(float3 from, float (&to)[3]) { to[0] = from.x, to[1] = from.y, to[2] = from.z; }

}  // namespace zoneplate
