// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "zoneplate/codec/ktx2/bits.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate::ktx2 {

/// The block-compressed formats of graphics cards, 4 × 4 texels a block, with unsigned normalized values
/// (BC6H, of floats: bc6h.h).
enum class BlockFormat {
  Bc1,       ///< colours, 8 bytes
  Bc1Alpha,  ///< the same; texels may be transparent
  Bc2,       ///< colours and 4-bit alpha, 16 bytes
  Bc3,       ///< colours and interpolated alpha, 16 bytes
  Bc4,       ///< red, 8 bytes
  Bc5,       ///< red and green, 16 bytes
  Bc7,       ///< colours and alpha of higher precision, 16 bytes
};

/// The format of Vulkan's number, sRGB or not; none for others.
std::optional<BlockFormat> block_format_of(std::uint32_t vulkan_format);

std::size_t block_bytes(BlockFormat format);

/// The texels of a block, row by row; channels that the format lacks are 0, alpha 1.
///
/// Requires  block_bytes(format) bytes.
/// Exact     BC1 to BC5: the nearest 8-bit value of the formula in real numbers. BC7: as its integers define it; a block
///           of the reserved mode is transparent black.
/// Source    Khronos Data Format Specification 1.4, "S3TC", "RGTC" and "BPTC Compressed Texture Image Formats".
std::array<Rgba8, 16> decode_block(BlockFormat format, std::span<const std::uint8_t> block, const Place& place);

/// Requires  as many blocks as the image has.
void decode_blocks(BlockFormat format, std::span<const std::uint8_t> blocks, const Place& place, Rgba8Image& image);

}  // namespace zoneplate::ktx2
