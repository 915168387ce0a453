// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "zoneplate/codec/ktx2/bits.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate::ktx2 {

/// Bytes of a UASTC block of 4 × 4 texels.
inline constexpr std::size_t uastc_block_bytes = 16;

/// The texels of a block, row by row. Errors: as Place::fail.
std::array<Rgba8, 16> decode_uastc_block(std::span<const std::uint8_t, uastc_block_bytes> block, const Place& place);

/// Requires  as many blocks as the image has.
void decode_uastc(std::span<const std::uint8_t> blocks, const Place& place, Rgba8Image& image);

}  // namespace zoneplate::ktx2
