// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/antialias/reference/analytic/polygon.h"
#include "zoneplate/raster/fragment/fragment_batcher.h"

namespace zoneplate::antialias {

/// Computes the difference of alpha and cutoff of alpha-tested triangles, for one footprint.
class AlphaTester {
 public:
  AlphaTester(const ProjectedDraws& projected, const FragmentShader& shader, Target target, float spacing)
      : target_(std::move(target)), shader_(projected, shader, target_) {
    target_.spacing = spacing;
  }
  AlphaTester(const AlphaTester&) = delete;  // the shader stores a reference to this target

  /// For each position, alpha minus the cutoff. The surface is present where that is >= 0.
  std::span<const float> margins(std::span<const Fragment> fragments) {
    shader_.evaluate_alpha_margins(fragments, margins_);
    return margins_;
  }
  std::uint64_t tested() const { return shader_.shaded(); }

 private:
  Target target_;
  FragmentBatcher shader_;
  std::vector<float> margins_;
};

/// The regions of a pixel where alpha-tested triangles are present: the contour where alpha equals the cutoff, as a
/// polyline, computed separately for parts of a pixel.
///
/// A part is one of grid × grid squares. If alpha at its four corners is on one side of the cutoff, and alpha at its
/// centre for the footprint of the whole part hardly differs from their mean, the triangle is present in all of the
/// part or in none of it. Otherwise the part is divided into 4 × 4 squares; where the corners of a square differ, the
/// contour is a straight line between its crossings of the square's sides (marching squares). A crossing is found by
/// bisection to 1/256 pixel and then interpolated.
///
/// Alpha     is evaluated for a footprint of 1/16 of a part, and extrapolated beyond the triangle's sides.
/// Errors    of a smooth contour: its sagitta over a quarter of a part; of a contour where alpha is discontinuous
///           (nearest-texel filtering): 1/512 pixel. Holes and islands smaller than a quarter of a part may be missed.
/// Source    Lorensen and Cline, Marching Cubes, SIGGRAPH 1987, in two dimensions.
class AlphaEdges {
 public:
  static constexpr int cells = 4;  ///< squares along the side of a part

  AlphaEdges(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target, int grid,
             float part_footprint, float footprint);

  void clear() { queries_.clear(); }
  std::size_t size() const { return queries_.size(); }
  /// Drops all queries after the first `count`.
  void shrink(std::size_t count) { queries_.resize(count); }
  /// Adds a query for a triangle in a part of the pixel (x, y); returns the index of its result.
  std::uint32_t add_query(int x, int y, std::int32_t id, std::uint32_t part);
  /// Evaluates all queries.
  void solve();

  /// Splits a polygon by result `number`: calls there(p) for the pieces where the triangle is present, away(p) for the
  /// others.
  /// Requires  at most 12 corners.
  template <class There, class Away>
  void split(std::uint32_t number, const ConvexPolygon& polygon, There there, Away away) const;

  std::uint64_t shaded() const { return coarse_.tested() + fine_.tested(); }

 private:
  static constexpr std::size_t corners = (cells + 1) * (cells + 1);
  static constexpr std::size_t sides = 2 * cells * (cells + 1);  ///< horizontal sides row by row, then vertical ones

  struct Query {
    std::int32_t x, y;  ///< the pixel, in 1/256 pixel
    std::int32_t id;
    int column, row;  ///< column and row of the part
    bool is_there = false;
    std::int32_t edge = -1;  ///< index into edges_ if the contour crosses the part
  };
  struct Edge {
    std::uint32_t query;
    std::array<float, corners> margin;  ///< row by row
    /// Position of the crossing on each side, from its left or upper end, in [0, 1].
    std::array<float, sides> crossing;
  };
  /// A crossing of alpha's contour with a side of a square, between two lattice positions.
  struct Crossing {
    std::uint32_t edge, side;
    Fragment low, high;  ///< the ends of the interval, in x or y
    float margin_low, margin_high;
    std::int32_t begin, length;
  };

  std::int32_t place(int cell) const;
  Fragment corner_point(const Query& a, int column, int row) const;
  void collect_mixed();
  void compute_grid_points();
  void compute_crossings();
  void add_crossing(std::uint32_t edge, std::uint32_t side, int column, int row, bool is_upright);
  void bisect();
  Place crossing_place(const Query& a, const Edge& e, int column, int row, bool is_upright) const;
  /// Lines that cut off the region of a square where the triangle is present (`keeps`), or absent.
  struct Cuts {
    bool keeps;
    int count = 0;
    std::array<Line, 2> line;
  };
  Cuts cuts_of(const Query& a, const Edge& e, int column, int row) const;

  const int grid_;
  AlphaTester coarse_, fine_;
  std::vector<Query> queries_;
  std::vector<Edge> edges_;
  std::vector<Crossing> crossings_;
  std::vector<Fragment> points_, centres_;
};

template <class There, class Away>
void AlphaEdges::split(std::uint32_t number, const ConvexPolygon& polygon, There there, Away away) const {
  const Query& a = queries_[number];
  if (a.edge < 0) return a.is_there ? there(polygon) : away(polygon);
  const Edge& e = edges_[static_cast<std::size_t>(a.edge)];
  const double part = 1.0 / grid_;
  for_grid(polygon, {a.column * part, a.row * part}, part / cells, cells,
           [&](int column, int row, const ConvexPolygon& square) {
             const Cuts cuts = cuts_of(a, e, column, row);
             ConvexPolygon rest = square, inside, outside;
             for (int i = 0; i < cuts.count && !rest.empty(); ++i) {
               cut(rest, cuts.line[static_cast<std::size_t>(i)], inside, outside);
               if (!inside.empty()) cuts.keeps ? there(inside) : away(inside);
               rest = outside;
             }
             if (!rest.empty()) cuts.keeps ? away(rest) : there(rest);
           });
}

}  // namespace zoneplate::antialias
