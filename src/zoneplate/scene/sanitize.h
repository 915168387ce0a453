// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// Sets vertices that are not finite to zero and drops the primitives that use one; returns the number of dropped ones.
///
/// Exact     the same bits for any number of threads.
std::uint64_t drop_not_finite(Mesh& mesh);

}  // namespace zoneplate
