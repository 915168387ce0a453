// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "zoneplate/math/vec.h"
#include "zoneplate/scene/texel_image.h"

namespace zoneplate {

/// True for the first bytes of a KTX 2 file.
bool is_ktx2(std::span<const std::uint8_t> bytes);

/// Width and height as the header states them.
std::optional<int2> find_ktx2_size(std::span<const std::uint8_t> bytes);

/// The bytes of a decoded texel, as the header states its format.
std::uint64_t ktx2_texel_memory(std::span<const std::uint8_t> bytes);

/// The maximum of bytes that decoding takes in addition to the image.
std::uint64_t ktx2_working_memory(std::span<const std::uint8_t> bytes);

/// Decodes level 0 of a KTX 2 texture: of Basis Universal, which glTF's KHR_texture_basisu uses, ETC1S with BasisLZ or
/// UASTC LDR 4 × 4; of blocks of graphics cards, BC1 to BC5 and BC7 of unsigned values, or BC6H; or of uncompressed
/// texels, of 8 or 16 bits a channel, halves, floats or packed floats. The level is as it is or packed by Zstandard.
///
/// Units     linear light for BC6H, halves and floats, else codes.
/// Exact     the texels of the formats' definition; the same bits everywhere.
/// Errors    ErrorKind::Input with `name` in front: corrupt, another format, more than `max_pixels`, arrays, cubes or
///           volumes; those of SharedLibrary for Zstandard.
/// Source    KTX File Format Specification 2.0, Khronos 2021, with its appendices on BasisLZ; Khronos Data Format
///           Specification 1.4, UASTC and ETC1S.
TexelImage decode_ktx2(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);

}  // namespace zoneplate
