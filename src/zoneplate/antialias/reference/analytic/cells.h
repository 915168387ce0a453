// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/antialias/reference/analytic/polygon.h"
#include "zoneplate/raster/geometry/draw.h"

namespace zoneplate::antialias {

/// A triangle relative to one pixel.
struct PixelTriangle {
  Line edge[3];                  ///< inside where all are positive
  bool covers_all = false;       ///< the triangle covers the whole region, so that the edges are ignored
  bool is_piece = false;         ///< a piece of a clipped triangle, whose other pieces have the same id
  double z = 0, zx = 0, zy = 0;  ///< reversed depth at the pixel's top-left corner, and its change per pixel
  std::int32_t id = 0;
  AlphaMode alpha_mode = AlphaMode::Opaque;
};

/// The visible surfaces of a pixel, or of a convex region of it: convex polygons that partition it, each with its
/// layers.
///
/// Layers are triangles from near to far, in the same order over the whole polygon; an opaque triangle is the last
/// layer. Alpha-tested triangles are layers like blended ones: their alpha is tested later. Where triangles intersect,
/// polygons are cut along the line of equal depths. Of triangles with equal depths the one with the lower id is nearer;
/// a polygon has at most one piece of a clipped triangle (one id).
///
/// Exact     the areas of the polygons add up to the region's within 1e-12; no polygon is dropped, however small.
/// Requires  an order of insertion that is independent of triangle ids, for results that are independent of them.
/// Source    subtraction of nearer polygons: Catmull, A Hidden-Surface Algorithm with Anti-Aliasing, SIGGRAPH 1978.
class PixelCells {
 public:
  static constexpr std::size_t max_cells = std::size_t{1} << 13, max_layers = std::size_t{1} << 20;

  struct Cell {
    ConvexPolygon polygon;
    std::uint32_t first_layer = 0, layers = 0;
  };

  /// Starts with an empty region, a convex part of the pixel or all of it.
  void clear(const ConvexPolygon& region);
  void insert(const PixelTriangle& triangle);

  /// True if there are too many cells or layers: the result is then incomplete, and insertions are ignored.
  bool is_full() const { return is_full_; }

  std::span<const Cell> cells() const { return cells_; }
  /// The layers of a cell, near to far: indices of triangles in the order of insertion.
  std::span<const std::uint32_t> layers_of(const Cell& cell) const {
    return {layers_.data() + cell.first_layer, cell.layers};
  }
  /// The number of entries in all lists of layers, including lists that are no longer used.
  std::size_t layer_count() const { return layers_.size(); }
  const PixelTriangle& triangle(std::uint32_t number) const { return triangles_[number]; }

 private:
  struct Piece {
    ConvexPolygon polygon;
    std::uint32_t next_layer;  ///< the layers before this one are in front of the piece
  };

  void insert_in(std::size_t cell, std::uint32_t number);
  bool is_hidden(const ConvexPolygon& polygon, const Cell& cell, const PixelTriangle& triangle) const;
  void sort_in(const Cell& cell, std::uint32_t number);
  void place(const Piece& piece, const Cell& cell, std::uint32_t number);
  void store(const ConvexPolygon& polygon, std::uint32_t first_layer, std::uint32_t layers);
  void store_with(const ConvexPolygon& polygon, const Cell& cell, std::uint32_t at, std::uint32_t number);

  std::vector<PixelTriangle> triangles_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> layers_;
  std::vector<Piece> pieces_;  ///< pieces that are not yet inserted
  bool is_full_ = false;
  std::size_t free_ = 0;  ///< index of a cell that may be overwritten; cells_.size() if there is none
};

}  // namespace zoneplate::antialias
