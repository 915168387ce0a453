// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/raster/tile/composite_pixels.h"
#include "zoneplate/raster/tile/opaque.h"

namespace zoneplate {

// Transparent surfaces of a tile of which only colours are stored. They are composited over the resolved opaque
// surfaces by three routes. Each route takes what the one before it has left, and all give the same bits as the last
// one alone:
//
//   1. Blocks of 8 × 8 pixels (BlockCompositor). Where every triangle that reaches a block covers all of its samples in
//      front of the opaque surfaces, and the depth ranges of the triangles do not overlap, one sort orders the block.
//      The spans of such blocks are shaded layer by layer from the front, until nothing behind is visible: nothing that
//      changes a colour or, where only display-referred colours are stored, their codes. All other blocks go to
//      route 2.
//   2. Spans of eight pixels (SpanCompositor). The same for each span by itself. A span is *slow* if a triangle covers
//      only a part of it, if two triangles' depth ranges overlap, if it shows several opaque surfaces, or if the
//      image's edge crosses it. Slow spans go to route 3.
//   3. Pixels (PixelCompositor). The layers of each sample are sorted; a pixel with more layers than may be stored is
//      peeled.
//
// Routes 1 and 2 evaluate one colour for each pixel and layer, at the pixel's centre, since the triangle covers all of
// the pixel's samples. `base` then takes the place of the opaque surface's samples.

/// Route 1.
class BlockCompositor {
 public:
  /// Composites the blocks that route 1 can draw; the result has a bit for each block that is left to the others.
  ///
  /// Requires  shade_opaque filled `opaque` and `colors`.
  std::uint64_t composite(const TileJob& job, const TileVisibility& visibility, FragmentBatcher& batcher,
                          const OpaqueFragments& opaque, TileColors& colors);

 private:
  void collect(const TileJob& job, const TileVisibility& visibility);
  void composite_strip(const TileJob& job, FragmentBatcher& batcher, const OpaqueFragments& opaque, std::uint32_t strip,
                       std::span<const BlockLayer> (&layers)[8], TileColors& colors);

  std::vector<BlockLayer> layers_, unsorted_;  ///< `layers_` block by block
  TransparentStack8 stacks_[64];               ///< by span of a strip of eight blocks
  std::uint64_t other_blocks_ = 0;
};

/// Route 2, and route 3 for the spans that route 2 leaves.
class SpanCompositor {
 public:
  /// Composites the blocks whose bits are set in `blocks`.
  ///
  /// Requires  shade_opaque filled `opaque` and `colors`.
  void composite(const TileJob& job, TileVisibility& visibility, FragmentBatcher& batcher, std::uint64_t blocks,
                 OpaqueFragments& opaque, PixelCompositor& pixels, TileColors& colors);

 private:
  /// A span whose layers end at `end` in spans_.
  struct CompositedSpan {
    std::uint32_t span;
    std::uint32_t end;
  };
  struct Strip {
    const TileJob& job;
    const TileVisibility& visibility;
    FragmentBatcher& batcher;
    std::uint64_t blocks;
    const OpaqueFragments& opaque;
    PixelCompositor& pixels;
    TileColors& colors;
  };
  void composite_strip(const Strip& strip, int top, int bottom);
  bool collect(const Strip& strip, int top, int bottom);
  bool sort_span(std::size_t first, std::size_t last);
  void shade_spans(const Strip& strip);
  void composite_slow_pixel(const Strip& strip, const PixelLayers& layers);

  std::vector<SpanLayer> layers_, sorted_;  ///< `layers_` span by span
  std::uint8_t is_slow_[tile_pixels / 8];
  std::vector<FragmentSpan> spans_;
  std::vector<CompositedSpan> composited_;
};

}  // namespace zoneplate
