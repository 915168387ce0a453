// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "zoneplate/raster/geometry/arena.h"
#include "zoneplate/raster/geometry/small_triangles.h"

namespace zoneplate {

/// The samples of small triangles that one thread has found, by tile. When a tile's list has grown long, only the
/// nearest entry of each sample is kept: a list is at most a few times as long as its visible part.
class TileSampleBins {
 public:
  /// Empties the lists, whose memory returns to the arena, and prepares them for this number of tiles. `keeps_hidden`:
  /// no entry is dropped.
  void clear(std::size_t tiles, int samples, bool keeps_hidden);

  /// Appends an empty bin to a tile's list.
  SampleBin* grow(std::size_t tile, std::int32_t first_id, Arena& arena);

  SampleBin** last() { return last_.data(); }  ///< by tile: the last part of its list, or null
  SampleBin* operator[](std::size_t tile) const { return last_[tile]; }

  static constexpr std::uint32_t enough = 64;  ///< a list of more parts than this is reduced

 private:
  struct Owner {
    float depth = -std::numeric_limits<float>::infinity();
    std::int32_t id = -1;
  };
  struct Kept {
    float depth;
    std::int32_t id;
    std::uint32_t at;
  };
  SampleBin* add_part(std::size_t tile, std::int32_t first_id, Arena& arena);
  void drop_hidden(std::size_t tile, Arena& arena);
  void compute_nearest(const SampleBin* list);

  std::vector<SampleBin*> last_;
  std::vector<std::uint32_t> parts_;  ///< by tile: number of parts of its list
  std::vector<std::uint32_t> limit_;  ///< by tile: parts at which hidden fragments are dropped
  SampleBin* free_ = nullptr;         ///< unused parts
  int samples_ = 0;                   ///< a pixel
  bool keeps_hidden_ = false;
  std::vector<Owner> nearest_;  ///< by sample of a tile
  std::vector<Kept> kept_;
};

}  // namespace zoneplate
