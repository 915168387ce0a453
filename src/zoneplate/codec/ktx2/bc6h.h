// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "zoneplate/codec/ktx2/bits.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate::ktx2 {

constexpr std::size_t bc6h_block_bytes = 16;

/// The texels of a BC6H block, row by row: linear light, alpha 1. `is_signed`: the values may be negative.
///
/// Requires  bc6h_block_bytes bytes.
/// Exact     the half floats that the format's integers define; a block of a reserved mode is black.
/// Source    Khronos Data Format Specification 1.4, "BPTC Compressed Texture Image Formats", BC6H.
std::array<float4, 16> decode_bc6h_block(std::span<const std::uint8_t> block, bool is_signed, const Place& place);

/// Requires  as many blocks as the image has.
void decode_bc6h(std::span<const std::uint8_t> blocks, bool is_signed, const Place& place, Plane<float4>& image);

}  // namespace zoneplate::ktx2
