// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/raster/geometry/project.h"
#include "zoneplate/raster/geometry/setup.h"

namespace zoneplate {

/// Samples of one tile that small triangles cover, in any order. A thread has a list of these bins for each tile.
///
/// Units     packed = 65536 (id - first_id) + at, at = 4096 sample + 64 y + x, with the pixel (x, y) within the tile.
struct SampleBin {
  static constexpr int capacity = 510;
  static constexpr int max_samples = 16;
  static constexpr std::int32_t max_ids = 0xffff;  ///< the range of ids in a bin, after first_id
  SampleBin* previous;
  std::int32_t count;
  std::int32_t first_id;
  float depth[capacity];
  std::uint32_t packed[capacity];

  static std::uint32_t at(std::uint32_t w) { return w & 0xffff; }
  std::int32_t id(std::uint32_t w) const { return first_id + static_cast<std::int32_t>(w >> 16); }
};

/// Appends the samples of one thread to its bins. `last`: by tile of the image's grid, the list's last bin, or null.
struct SampleBinWriter {
  std::int32_t first_column, first_row, columns;
  SampleBin** last;
  void* owner;
  /// Appends an empty bin for triangles from `first_id` on.
  SampleBin* (*grow)(SampleBinWriter& sink, std::int32_t tile, std::int32_t first_id);
};

/// A run of consecutive triangles of one draw, with the parameters of their tests.
struct SmallTriangleRun {
  const ScreenVertex* screen;
  const std::uint32_t* index;  ///< three a triangle
  std::int32_t count;          ///< at most `capacity`
  std::int32_t first_id;
  Viewport viewport;
  /// The pixels that are drawn, ends included. Samples outside of them are found too, within their tiles.
  std::int32_t left, top, right, bottom;
  const std::int32_t *sample_x, *sample_y;
  std::int32_t sample_count;
  std::int32_t facing;  ///< 1 keeps triangles that are clockwise on the screen, -1 the others, 0 both
  EdgeRule edge_rule;
  /// 1/256 pixel: triangles that are no wider and no higher become samples; at most 2047. -1: none; required if there
  /// are more samples than SampleBin::max_samples.
  std::int32_t small_extent;

  Triangle* records;  ///< array for visible triangles that are not small; null: they are listed, not set up

  static constexpr int capacity = 256;
};

/// The results for a run's triangles, as indices within the run.
struct SmallTriangleResult {
  std::int32_t deferred_count = 0, visible_count = 0;
  std::uint64_t drawn = 0;  ///< small triangles that were converted to samples
  std::int32_t
      deferred[SmallTriangleRun::capacity + 16];  ///< need clipping, or are larger than 64 pixels: not yet tested
  std::int32_t visible[SmallTriangleRun::capacity + 16];  ///< face the eye, have a sample in their bounds, are in the
                                                          ///< rectangle; not written where there is room for records
};

struct SmallTriangleKernels : PerIsa<SmallTriangleKernels> {
  /// Culls a run of triangles, converts the small ones to samples, and sets up or lists the rest, in their order.
  ///
  /// The samples of small triangles and their depths are those of make_tile_triangle and depth_at, bit for bit.
  void (*run)(const SmallTriangleRun& run, SampleBinWriter& sink, SmallTriangleResult& result);
};

inline constexpr std::int32_t large_extent = 16383;  ///< 1/256 pixel; products of two differences stay within 28 bits

}  // namespace zoneplate
