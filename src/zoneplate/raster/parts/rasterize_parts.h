// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "zoneplate/base/ranks/ranks.h"
#include "zoneplate/raster/tile/rasterize.h"

namespace zoneplate {

/// Which pixels of the target's planes a rank has after rasterize_parts: those that are not 0, in planes of the
/// target's size.
struct HeldPixels {
  Plane<std::uint8_t> colors;  ///< of colours, coverage and the planes by sample
  Plane<std::uint8_t> data;    ///< of the data planes
};

/// Milliseconds of this rank.
struct PartTimes {
  double visibility = 0;  ///< rasterizing its triangles
  double merge = 0;       ///< packing, exchanging and merging visible samples
  double shading = 0;     ///< shading its fragments
  double resolve = 0;     ///< exchanging and compositing their colours
};

/// Draws triangles that several ranks have: each rasterizes its own, and all ranks together give the planes that
/// `rasterize` gives for all triangles (sort-last). Every rank calls it with the same draws, in which the triangles of
/// others are `elsewhere`.
///
/// In bands of tiles, each of which one rank resolves:
///   1. each rank rasterizes its opaque triangles, and sends the samples that they own, packed, to the tile's rank;
///   2. that rank merges them by (depth, id). Alpha-tested triangles are tested by their ranks against the result, and
///      merged likewise;
///   3. it sends each rank the set of samples that this rank owns, and what lies before its blended triangles;
///   4. each rank shades its fragments, opaque and blended, which only it has vertices and materials for, and sends
///      their colours, in the order of the pixels;
///   5. the tile's rank composites the layers of each sample in the order of (depth, id), and resolves the pixels.
/// A tile that only one rank's triangles touch is drawn by that rank alone.
///
/// Exact     the bits of `rasterize`, for any number of ranks and any distribution of the triangles.
/// Errors    those of `rasterize`, on the rank where they happen: the others then wait in Ranks::exchange.
RasterCounts rasterize_parts(std::span<const Draw> draws, const FragmentShader& shader, const RasterRules& rules,
                             const Target& target, RasterMemory& memory, Ranks& ranks, HeldPixels& held,
                             PartTimes& times);

}  // namespace zoneplate
