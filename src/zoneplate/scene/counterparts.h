// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The index of no instance.
inline constexpr std::uint32_t no_instance = 0xffffffffu;

/// For each instance of a scene, the index of the same one at another moment of the scene, or no_instance.
///
/// Instances are the same if they have the same object and the same part; several with both in common correspond in
/// their order.
/// Cost      linear where both moments have the same instances in the same order, else that of sorting.
std::vector<std::uint32_t> counterparts(const Scene& now, const Scene& other);

}  // namespace zoneplate
