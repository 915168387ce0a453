#pragma once

#include <cstdint>

#include "zoneplate/scene/texel_image.h"

namespace zoneplate {

/// The colour image, at its own size, with an opacity map as its alpha; without a colour image, white at the map's
/// size.
///
/// A texel of the map is as opaque as its alpha says where the map has any that is not 1, else as its luma (Rec. 709 of
/// codes, or of light as it is) says. The result has as many bits as the more precise of the two: light where the
/// colour image is light, or where there is none and the map is; else 16 bits where one of the two has more than 8.
/// Requires  no image is empty.
TexelImage with_opacity(const TexelImage* color, const TexelImage& map);

/// Bytes that the texels of `with_opacity` take.
std::uint64_t with_opacity_memory(const TexelImage* color, const TexelImage& map);

/// True if no texel's alpha is below 1.
bool is_opaque(const TexelImage& image);

}  // namespace zoneplate
