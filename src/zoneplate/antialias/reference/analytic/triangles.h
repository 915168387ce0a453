// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "zoneplate/raster/geometry/draw.h"
#include "zoneplate/raster/geometry/setup.h"
#include "zoneplate/raster/types/target.h"

namespace zoneplate::antialias {

/// A triangle on the screen, with the rasterizer's snapped vertices and depth plane, even if it covers no sample.
struct ScreenTriangle {
  Triangle shape;  ///< without the top-left rule: E is the exact doubled area
  AlphaMode alpha_mode = AlphaMode::Opaque;
  bool is_piece = false;  ///< piece of a clipped triangle
};

/// The triangles of a frame, culled and clipped as for drawing, binned by the tiles whose pixels they may overlap.
///
/// Only ids are stored, for some rows of tiles at a time; the triangles are set up for the current rows of pixels.
///
/// Exact     each tile gets the same triangles for any number of threads, in any order.
/// Memory    4 bytes for each triangle and tile of the listed rows: at most `max_listed`, or one row.
class TileTriangles {
 public:
  static constexpr std::size_t max_listed = std::size_t{1} << 24;

  /// A tile's list contains the triangles within `radius` pixels of the tile.
  TileTriangles(const ProjectedDraws& projected, const Target& target, const RasterRules& rules, int radius);

  int first_column() const { return first_column_; }  ///< in tiles of 64 × 64 on the image's own grid
  int first_row() const { return first_row_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  std::uint64_t count() const { return count_; }  ///< front-facing triangles that overlap the target

  /// Replaces the lists by those of the tiles of the rows from `first` on; returns the row after the last listed one.
  int list_rows(int first);
  /// The ids of the triangles of a listed tile; tiles are numbered row by row from the first row.
  std::span<const std::int32_t> of_tile(std::size_t tile) const {
    return std::span(listed_).subspan(first_[tile] - listed_from_, first_[tile + 1] - first_[tile]);
  }
  /// Sets up the tile's triangles that overlap the rows of pixels [top, bottom).
  void make(std::size_t tile, int top, int bottom, std::vector<ScreenTriangle>& out) const;

 private:
  /// The pixels that a triangle may overlap; right and bottom are inclusive.
  struct Box {
    int left, top, right, bottom;
  };
  /// A run of consecutive triangles of one draw.
  struct Part {
    std::size_t draw;
    std::int32_t begin, end;
  };

  template <class Use>
  void for_pieces(std::size_t draw, std::int32_t id, Use use) const;
  template <class Use>
  void for_triangles(const Part& part, Use use) const;
  template <class Use>
  void for_tiles(const Box& box, Use use) const;

  const ProjectedDraws& projected_;
  const Target& target_;
  const RasterRules rules_;
  const int radius_;
  int first_column_ = 0, first_row_ = 0, columns_ = 0, rows_ = 0;
  std::uint64_t count_ = 0;
  std::vector<Part> parts_;
  /// Index of each tile's first entry among all, and the total at the end.
  std::vector<std::size_t> first_;
  std::unique_ptr<std::atomic<std::uint32_t>[]> counter_;  ///< by tile
  std::vector<std::int32_t> listed_;
  std::size_t listed_from_ = 0;  ///< index of the first listed entry among all
};

}  // namespace zoneplate::antialias
