// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/shade/texture/growing_memory.h"
#include "zoneplate/shade/texture/texture_view.h"

/// The tables that Texture makes from level 0 at first use. Errors: std::bad_alloc.
namespace zoneplate {

/// The number of texels of all levels, with borders and with what may be read after them.
std::size_t texel_count(const TextureView& view);

struct RipmapTable {
  GrowingMemory memory;
  RipmapView view;
};
RipmapTable make_ripmap(const TextureView& texture);

struct SumsTable {
  GrowingMemory memory;
  SumsView view;
};
SumsTable make_sums(const TextureView& texture);

/// As Texture::normal_spread: the moments of the unit normals and of their slopes are averaged exactly from level 0,
/// level by level.
struct NormalSpread {
  GrowingMemory memory;
  TextureView view;
};
NormalSpread make_normal_spread(const TextureView& texture);

}  // namespace zoneplate
