// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "zoneplate/raster/geometry/arena.h"
#include "zoneplate/raster/geometry/draw.h"
#include "zoneplate/raster/geometry/fragments.h"
#include "zoneplate/raster/geometry/setup.h"
#include "zoneplate/raster/geometry/small_triangles.h"
#include "zoneplate/raster/types/target.h"

namespace zoneplate {

/// The sample positions of a pattern as arrays.
struct SampleArrays {
  std::vector<std::int32_t> x, y;
  explicit SampleArrays(const SamplePattern& samples) {
    for (const SamplePosition s : samples) x.push_back(s.x), y.push_back(s.y);
  }
};

/// The triangles of a frame by the tiles that they may touch.
///
/// Each thread fills its own lists. Visibility does not depend on the order of drawing, so it does not matter which
/// thread set up a triangle. Small opaque triangles have no record: the samples that they cover are in `fragments`.
struct Bins {
  int first_column = 0, first_row = 0, columns = 0,
      rows = 0;  ///< the tiles of the image's grid that the target overlaps
  using TileList = ArenaList<std::uint32_t>;
  struct alignas(128) Worker {
    Arena arena;
    ArenaArray<Triangle> triangles;
    std::vector<std::array<TileList, 3>> tiles;  ///< by tile and AlphaMode: indices into triangles
    TileSampleBins fragments;
    std::uint64_t drawn = 0;  ///< triangles that became samples

    /// Empties the lists and prepares them for this number of tiles.
    void clear(std::size_t tiles, const Target& target);
    bool is_empty(std::size_t tile) const {
      const auto& lists = this->tiles[tile];
      return lists[0].empty() && lists[1].empty() && lists[2].empty() && fragments[tile] == nullptr;
    }
  };
  std::vector<Worker> workers;
  std::uint64_t set_up = 0;  ///< triangles that survived culling and clipping

  /// True if nothing touches a tile.
  bool is_empty(std::size_t tile) const {
    return std::all_of(workers.begin(), workers.end(), [&](const Worker& w) { return w.is_empty(tile); });
  }
  std::size_t tiles() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// Empty bins for the tiles of a target, in the memory of `reused`.
Bins make_bins(const Target& target, Bins reused = {});

/// Culls, clips, sets up and sorts into tiles the triangles of the draws [first, last), in parallel.
///
/// Requires  stored screen vertices of these draws; fewer than 2^32 triangles survive.
void add_to_bins(const ProjectedDraws& projected, std::size_t first, std::size_t last, const Target& target,
                 const RasterRules& rules, Bins& bins);

/// make_bins and add_to_bins for all draws.
Bins bin_triangles(const ProjectedDraws& projected, const Target& target, const RasterRules& rules, Bins reused = {});

}  // namespace zoneplate
