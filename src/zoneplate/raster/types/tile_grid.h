// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zoneplate {

inline constexpr int tile_size = 64;
inline constexpr int tile_pixels = tile_size * tile_size;

/// The id of a sample without a triangle; greater than any triangle id.
inline constexpr std::int32_t no_primitive = 0x7fffffff;

/// The id of a group of samples with different visible primitives.
inline constexpr std::int32_t mixed_primitives = -1;

}  // namespace zoneplate
