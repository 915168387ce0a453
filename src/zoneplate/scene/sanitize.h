#pragma once

#include <cstdint>

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// Makes vertices that are not finite zero and drops the primitives that use one; says how many were dropped.
///
/// Exact     the same bits for any number of threads.
std::uint64_t drop_not_finite(Mesh& mesh);

}  // namespace zoneplate
