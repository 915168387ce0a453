// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/antialias/reference/analytic/alpha.h"
#include "zoneplate/antialias/reference/analytic/colors.h"
#include "zoneplate/antialias/reference/analytic/fragments.h"

namespace zoneplate::antialias {

/// The polygons under alpha-tested surfaces until alpha is evaluated: they are cut by a grid, then along the contours
/// of alpha.
class MaskedPolygons {
 public:
  static constexpr std::size_t max_triangles = 8;  ///< alpha-tested triangles in a pixel

  MaskedPolygons(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target, int grid,
                 Footprints footprints)
      : grid_(grid), edges_(projected, shader, target, grid, footprints.alpha_part, footprints.alpha) {}

  void clear();
  /// The number of pending polygons and alpha queries.
  std::size_t size() const { return stored_.size() + edges_.size(); }
  void begin_pixel(int x, int y);
  /// Drops the polygons of this pixel.
  void abandon_pixel();
  /// Stores a polygon with its layers. If the limits of a pixel are exceeded, returns false and stores nothing.
  bool add(const ConvexPolygon& polygon, std::span<const Layer> layers);

  /// Evaluates alpha and adds the visible fragments to the list, pixel by pixel.
  void resolve(AreaFragmentList& out);

  std::uint64_t shaded() const { return edges_.shaded(); }

 private:
  struct Stored {
    ConvexPolygon polygon;
    int x, y;
    std::uint32_t part;
    std::uint32_t first_layer, layers;
    std::uint32_t first_answer;  ///< index of the first query of its masked layers; the others follow in order
  };

  bool knows_masked(std::span<const Layer> layers);
  void store(const ConvexPolygon& polygon, std::uint32_t part, std::span<const Layer> layers);
  std::uint32_t answer_of(std::int32_t id, std::uint32_t part);
  void walk(const Stored& stored, const ConvexPolygon& polygon, std::uint32_t layer, std::uint32_t answer,
            AreaFragmentList& out);

  const int grid_;
  AlphaEdges edges_;
  std::vector<Stored> stored_;
  std::vector<Layer> layers_;
  std::vector<std::uint32_t> answers_;  ///< indices in edges_
  std::vector<Layer> seen_;             ///< layers in front of the current piece

  int x_ = 0, y_ = 0;  ///< the current pixel
  std::size_t stored_before_ = 0, layers_before_ = 0, answers_before_ = 0, asked_before_ = 0;
  std::vector<std::int32_t> masked_;         ///< the pixel's masked triangles
  std::vector<std::uint32_t> known_answer_;  ///< for each masked triangle and part: the query's index plus 1, or 0
};

}  // namespace zoneplate::antialias
