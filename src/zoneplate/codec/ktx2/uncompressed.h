// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "zoneplate/scene/texel_image.h"

namespace zoneplate::ktx2 {

/// How a channel, or a texel of three channels, is stored.
enum class ChannelType : std::uint8_t {
  Unorm8,   ///< 8-bit codes, sRGB or not
  Unorm16,  ///< 16-bit codes
  Half,     ///< binary16
  Float,    ///< binary32
  Float11,  ///< red and green of 11 bits, blue of 10, without sign, in 32 bits
  Shared9,  ///< three mantissas of 9 bits with one exponent of 5, in 32 bits
};

struct UncompressedFormat {
  ChannelType type;
  std::uint8_t channels;     ///< 1 to 4: red, green, blue, alpha
  bool is_reversed = false;  ///< blue is first
};

/// The format of Vulkan's number, sRGB or not; none for others.
std::optional<UncompressedFormat> uncompressed_format_of(std::uint32_t vulkan_format);

std::size_t texel_bytes(UncompressedFormat format);

/// An image of rows from the top, little-endian; channels that the format lacks are 0, alpha 1.
///
/// Requires  width × height × texel_bytes(format) bytes.
/// Source    Khronos Data Format Specification 1.4, 10 and 11; Vulkan 1.3, "Formats".
TexelImage decode_uncompressed(UncompressedFormat format, std::span<const std::uint8_t> bytes, int width, int height);

}  // namespace zoneplate::ktx2
