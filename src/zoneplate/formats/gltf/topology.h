// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/scene/mesh.h"

namespace zoneplate {

/// The topology of a glTF primitive with this mode.
///
/// Requires  mode in [0, 6]: points, lines, line loop, line strip, triangles, triangle strip, triangle fan.
Topology gltf_topology(int mode);

/// Converts the vertices of a glTF primitive to a list, with 1, 2 or 3 indices for each point, line or triangle.
///
/// Every triangle keeps its winding: the strip's i-th is (i, i + 1 + i % 2, i + 2 - i % 2), the fan's (i + 1, i + 2,
/// 0). Excess vertices at the end are ignored.
std::vector<std::uint32_t> list_primitives(std::vector<std::uint32_t> order, int mode);

}  // namespace zoneplate
