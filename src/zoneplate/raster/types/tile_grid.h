#pragma once

#include <cstdint>

namespace zoneplate {

inline constexpr int tile_size = 64;
inline constexpr int tile_pixels = tile_size * tile_size;

/// The id of a sample that no triangle owns; greater than any triangle's.
inline constexpr std::int32_t no_primitive = 0x7fffffff;

/// In place of an id, where samples have different visible primitives.
inline constexpr std::int32_t mixed_primitives = -1;

}  // namespace zoneplate
