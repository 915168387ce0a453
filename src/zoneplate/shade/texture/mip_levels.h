// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/shade/texture/texture.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {

/// Makes all levels of a texture from level 0, each from the level before it. `codes` are the texels of `view`, as
/// unorm8 (std::uint8_t), unorm15 (std::uint16_t), half floats or floats.
template <class Code>
void make_mip_levels(Code* codes, const TextureView& view, const LevelOptions& options);

}  // namespace zoneplate
