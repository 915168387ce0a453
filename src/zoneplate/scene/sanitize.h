// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// Replaces vertices that are not finite by zero and drops the primitives that use one; returns the number of dropped
/// primitives.
///
/// Exact     the same bits for any number of threads.
std::uint64_t drop_not_finite(Mesh& mesh);

}  // namespace zoneplate
