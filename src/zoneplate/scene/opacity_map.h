// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/scene/texel_image.h"

namespace zoneplate {

/// The colour image at its own size, with an opacity map as its alpha; without a colour image, white at the map's size.
///
/// The opacity of a texel is the alpha of the map if any alpha of the map differs from 1, otherwise its luma (Rec. 709,
/// of encoded or linear values as stored). The result has the precision of the more precise of the two images: linear
/// light if the colour image is linear, or if there is none and the map is linear; otherwise 16 bits if one of them has
/// more than 8.
/// Requires  no image is empty.
TexelImage with_opacity(const TexelImage* color, const TexelImage& map);

/// The size in bytes of the texels of `with_opacity`.
std::uint64_t with_opacity_memory(const TexelImage* color, const TexelImage& map);

/// True if the alpha of no texel is below 1.
bool is_opaque(const TexelImage& image);

}  // namespace zoneplate
