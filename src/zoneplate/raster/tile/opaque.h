// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/raster/fragment/fragment_batcher.h"
#include "zoneplate/raster/fragment/fragment_list.h"
#include "zoneplate/raster/tile/output.h"
#include "zoneplate/raster/tile/visibility.h"

namespace zoneplate {

/// The fragments of a tile's visible surfaces, opaque and alpha-tested.
struct OpaqueFragments {
  std::int32_t span_primitive[tile_pixels / 8];  ///< as CoverageKernels::fetch_owners gives them
  std::vector<FragmentSpan> spans;               ///< eight pixels that one triangle owns; some at the end may be unused
  FragmentList list;                             ///< fragments of other spans, where there is no transparency
  std::vector<std::uint32_t> listed_spans;       ///< the first pixels of the spans that `list` holds
  std::vector<Linear> list_sums;                 ///< by pixel: the weighted sum of the listed fragments' colours

  std::vector<Fragment> fragments;            ///< fragments one by one, pixel by pixel
  std::vector<Linear> colors;                 ///< of `fragments`
  std::vector<std::uint32_t> first_fragment;  ///< by pixel, and the number of fragments at the end
};

/// Lists one fragment for each triangle that owns samples of the pixel, in the order of their first samples; at rate
/// *sample* one for each sample.
void add_pixel(const TileJob& job, const TileVisibility& visibility, std::uint32_t pixel, std::vector<Fragment>& out);

/// Shades the visible surfaces of a tile of which only colours are stored, and resolves the pixels as far as they need
/// no other stage: `color` of spans (and `base`, which transparent surfaces are composited over) and of listed pixels.
/// The colours of `fragments` remain for resolve_fragments.
///
/// Spans that one triangle owns are shaded as spans. Of the others each pixel's fragments are listed; the list is
/// shaded whenever it is full, so that it stays in the cache.
void shade_opaque(const TileJob& job, const TileVisibility& visibility, FragmentBatcher& batcher,
                  OpaqueFragments& opaque, TileColors& colors);

/// `color` of the pixels that have `fragments`: the weighted mean of their colours.
void resolve_fragments(const TileJob& job, const OpaqueFragments& opaque, TileColors& colors);

/// Lists the fragments of all pixels one by one, with first_fragment. Requires: materialized blocks.
void list_fragments(const TileJob& job, const TileVisibility& visibility, OpaqueFragments& opaque);

/// Adds the colours of a pixel's fragments to `sum` and their samples to `coverage`.
void add_fragments_to_sum(const TileJob& job, const OpaqueFragments& opaque, std::uint32_t pixel, TileColors& colors);

}  // namespace zoneplate
