// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/raster/geometry/setup.h"
#include "zoneplate/raster/types/tile_grid.h"

namespace zoneplate {

/// What is visible in one tile: depth and triangle id of every sample, planes by sample, 64 × 64 each.
///
/// The owner of a sample is the triangle of greatest depth there, of those the one with the lowest id: a total order,
/// so the triangles may be drawn in any order.
///
/// For each of the 8 × 8 blocks of 8 × 8 pixels `block_min_depth` is a lower bound of the depths of the block's
/// samples, and `block_primitive` the triangle that owns all of them, or `mixed_primitives`. A block with
/// `no_primitive` is empty and its samples are uninitialised: `materialize_block` must be called before they are
/// written.
struct TileVisibility {
  static constexpr int blocks = 64;
  int sample_count = 1;
  float* depth = nullptr;
  std::int32_t* id = nullptr;
  float* block_min_depth = nullptr;
  std::int32_t* block_primitive = nullptr;
  std::uint64_t dirty = 0;  ///< a bit for each block whose `block_min_depth` may be too low

  /// Nothing is drawn yet.
  void clear();
  /// Initialises the block's samples, so that they may be read and written one by one.
  void materialize_block(int block);
  void materialize_all();
};

/// A pixel that a triangle covers in front of the tile's depths, with the samples where it does.
struct CoveredPixel {
  std::uint64_t samples;  ///< bit s: sample s
  std::uint32_t pixel;    ///< 64 y + x within the tile
};

/// Eight neighbouring pixels of a row where a triangle is in front of the tile's depth at every sample.
struct SpanLayer {
  std::int32_t id;
  std::uint32_t row;      ///< 8 y + x / 8 within the tile
  float least, greatest;  ///< its depths there
};

/// A block of 8 × 8 pixels where a triangle covers every sample in front of all of the tile's depths in the block.
struct BlockLayer {
  std::int32_t id;
  std::uint32_t block;
  float least, greatest;  ///< its depths there
};

struct CoverageKernels : PerIsa<CoverageKernels> {
  /// Draws a triangle into the tile: every covered sample that it wins takes its depth and id. Returns true if some
  /// block's `block_min_depth` may have risen.
  bool (*draw)(const TileTriangle& triangle, TileVisibility& tile);
  /// Lists the pixels where the triangle would win at least one sample, row by row, and returns their number; draws
  /// nothing. `out` has the capacity for every pixel of the tile.
  ///
  /// Requires  open blocks.
  int (*collect)(const TileTriangle& triangle, const TileVisibility& tile, CoveredPixel* out);
  /// Lists the rows of 8 pixels where the triangle would win every sample, in the lines from first_y to last_y; sets
  /// is_partial[row] where it would win some but not all. Only in blocks whose bit is set. `out` has the capacity for
  /// every row of those lines.
  ///
  /// Requires  open blocks.
  int (*collect_rows)(const TileTriangle& triangle, const TileVisibility& tile, std::uint64_t blocks, SpanLayer* out,
                      std::uint8_t* is_partial);
  /// The greatest depth of the samples of each block; 0 where nothing is drawn.
  void (*compute_nearest)(const TileVisibility& tile, float* nearest);
  /// Lists the blocks where the triangle covers every sample and is in front of `nearest`; sets the bits in `others` of
  /// the other blocks where it may win some. `out` has the capacity for every block; the result is their number.
  int (*collect_blocks)(const TileTriangle& triangle, const TileVisibility& tile, const float* nearest, BlockLayer* out,
                        std::uint64_t& others);
  /// The owner of each span of 8 pixels, 8 × 64 of them: the triangle that owns all of its samples, `no_primitive` if
  /// it is empty, otherwise `mixed_primitives`.
  void (*fetch_owners)(const TileVisibility& tile, std::int32_t* owners);
};

}  // namespace zoneplate
