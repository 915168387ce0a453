#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "zoneplate/raster/draw.h"
#include "zoneplate/raster/setup.h"
#include "zoneplate/raster/target.h"

namespace zoneplate {

/// The triangles of a frame by the tiles that they may touch.
///
/// Each thread fills its own lists; which thread set up a triangle leaves no trace in the picture, because what is
/// visible does not depend on the order of drawing.
struct Bins {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;  ///< tiles of 64 × 64 on the picture's own grid
  struct Worker {
    std::vector<Triangle> triangles;
    std::vector<std::array<std::vector<std::uint32_t>, 3>> tiles;  ///< by tile and Surface: indices into triangles
  };
  std::vector<Worker> workers;
  std::uint64_t set_up = 0;  ///< triangles that survived culling and clipping

  std::size_t tiles() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// Culls, clips, sets up and sorts into tiles, in parallel.
Bins bin_triangles(const ProjectedDraws& projected, const Target& target, const SetupRules& rules);

}  // namespace zoneplate
