// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

bool are_finite(std::span<const float> values);

/// What drop_not_finite changed.
struct NotFinite {
  std::uint64_t dropped = 0;   ///< primitives
  std::uint64_t replaced = 0;  ///< vertices with other attributes
};

/// Drops the primitives that use a vertex whose position is not finite. Other attributes that are not finite do not
/// cost a primitive: normals, tangents and texture coordinates become zero, colours white.
///
/// Exact     the same bits for any number of threads.
NotFinite drop_not_finite(Mesh& mesh);

}  // namespace zoneplate
