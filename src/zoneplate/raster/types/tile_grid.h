// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zoneplate {

inline constexpr int tile_size = 64;
inline constexpr int tile_pixels = tile_size * tile_size;

/// The distance between the planes of two samples in TileVisibility: a cache line more than a tile, since the samples
/// of a pixel would otherwise map to the same few sets of the first-level cache.
inline constexpr int sample_stride = tile_pixels + 16;

/// The place in these planes of pixel p of sample s, from at = tile_pixels s + p.
constexpr std::uint32_t sample_place(std::uint32_t at) { return at + at / tile_pixels * (sample_stride - tile_pixels); }

/// The id of a sample without a triangle; greater than any triangle id.
inline constexpr std::int32_t no_primitive = 0x7fffffff;

/// The id of a group of samples with different visible primitives.
inline constexpr std::int32_t mixed_primitives = -1;

}  // namespace zoneplate
