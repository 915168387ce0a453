#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/antialias/reference/analytic/polygon.h"
#include "zoneplate/raster/geometry/draw.h"

namespace zoneplate::antialias {

/// A triangle as one pixel sees it.
struct PixelTriangle {
  Line edge[3];                  ///< inside where all are positive
  bool covers_all = false;       ///< of the region at work: the edges are not looked at
  bool is_piece = false;         ///< of a clipped triangle: others may have its id
  double z = 0, zx = 0, zy = 0;  ///< reversed depth at the pixel's top-left corner, and its change per pixel
  std::int32_t id = 0;
  AlphaMode alpha_mode = AlphaMode::Opaque;
};

/// What is visible in a pixel, or a convex region of it: convex polygons that fill it without a gap or an overlap, each
/// with its layers.
///
/// TransparentStack are triangles from near to far, the same order all over the polygon; an opaque one is the last.
/// Masked triangles are layers like blended ones: whether they are there is asked later. Where triangles pass through
/// each other polygons are cut along the line of equal depths. Of equal depths the triangle with the lower id is
/// nearer; of pieces of one triangle (one id) a polygon has one.
///
/// Exact     the areas of the polygons sum to the region's within 1e-12; no part is dropped, however small.
/// Requires  triangles come in an order that does not depend on how they are numbered, if the bits of the polygons are
///           not to.
/// Source    subtraction of nearer polygons: Catmull, A Hidden-Surface Algorithm with Anti-Aliasing, SIGGRAPH 1978.
class PixelCells {
 public:
  static constexpr std::size_t most_cells = std::size_t{1} << 13, most_layers = std::size_t{1} << 20;

  struct Cell {
    ConvexPolygon polygon;
    std::uint32_t first_layer = 0, layers = 0;
  };

  /// Nothing is in the region, a convex part of the pixel or all of it.
  void clear(const ConvexPolygon& region);
  void insert(const PixelTriangle& triangle);

  /// True once the cells or their layers are too many: they are then not complete, and nothing is inserted any more.
  bool is_full() const { return is_full_; }

  std::span<const Cell> cells() const { return cells_; }
  /// Of a cell: numbers of triangles, in the order of insertion, near to far.
  std::span<const std::uint32_t> layers_of(const Cell& cell) const {
    return {layers_.data() + cell.first_layer, cell.layers};
  }
  /// Entries in the cells' lists of layers, and in those that no cell has any more.
  std::size_t layer_count() const { return layers_.size(); }
  const PixelTriangle& triangle(std::uint32_t number) const { return triangles_[number]; }

 private:
  struct Piece {
    ConvexPolygon polygon;
    std::uint32_t next_layer;  ///< what is before it is in front
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
  std::vector<Piece> pieces_;  ///< still to be placed
  bool is_full_ = false;
  std::size_t free_ = 0;  ///< a cell whose place may be taken; cells_.size() if there is none
};

}  // namespace zoneplate::antialias
