#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/raster/draw.h"
#include "zoneplate/raster/setup.h"
#include "zoneplate/raster/target.h"

namespace zoneplate::antialias {

/// A triangle on the screen: the rasterizer's own snapped vertices and depth plane, whether it holds a sample or not.
struct ScreenTriangle {
  Triangle shape;  ///< every triangle owns its edges: E is the exact doubled area
  Surface surface = Surface::Opaque;
  bool is_piece = false;  ///< of a clipped triangle
};

/// The triangles of a frame, culled and clipped as for drawing, by the tiles whose pixels they may touch.
struct ScreenTriangles {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;  ///< tiles of 64 × 64 on the picture's own grid
  std::vector<ScreenTriangle> triangles;                       ///< in the order of the draws
  std::vector<std::uint32_t> listed;                           ///< numbers of triangles, tile by tile
  std::vector<std::size_t> first;                              ///< of each tile in `listed`, and the total at the end

  std::size_t tiles() const { return first.size() - 1; }
  std::span<const std::uint32_t> of_tile(std::size_t tile) const {
    return std::span(listed).subspan(first[tile], first[tile + 1] - first[tile]);
  }
};

/// Makes the triangles in parallel. A tile's list holds what comes within `reach` pixels of the tile.
///
/// Exact     the same list for any number of threads.
ScreenTriangles make_screen_triangles(const ProjectedDraws& projected, const Target& target, const SetupRules& rules,
                                      int reach);

}  // namespace zoneplate::antialias
