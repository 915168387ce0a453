// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/scene/texel_image.h"

namespace zoneplate {

/// The image of a metallic-roughness texture: the red channel of one image as its green (roughness), that of another as
/// its blue (metallic), at the size of the first that is given; a missing one counts as 1.
///
/// The result has 8 bits if both images have, otherwise it is linear.
/// Requires  one of the two at least; no image is empty.
TexelImage with_metallic_roughness(const TexelImage* roughness, const TexelImage* metallic);

/// Bytes that the texels of `with_metallic_roughness` take.
std::uint64_t with_metallic_roughness_memory(const TexelImage* roughness, const TexelImage* metallic);

}  // namespace zoneplate
