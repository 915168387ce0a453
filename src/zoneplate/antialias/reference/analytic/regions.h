// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "zoneplate/antialias/reference/analytic/cells.h"

namespace zoneplate::antialias {

/// Finds the visible surfaces of a pixel, region by region: a crowded pixel is divided into quarters, and crowded
/// quarters again, so that each triangle is compared only with nearby triangles. Triangles that cover a region in one
/// order, in any number, do not count as a crowd, because they cause no cuts.
///
/// Exact     as PixelCells: the polygons of all regions together fill the pixel. Whether a region is divided depends
///           only on the positions of the triangles.
/// Cost      about n log n for n visible triangles, instead of n². A pixel that would exceed `max_work` is given up.
class PixelRegions {
 public:
  /// Returns false to give up the pixel.
  using Use = std::function<bool(const PixelCells&)>;

  /// Maximum number of cells that triangles are compared with, plus a quarter of the number of layers.
  static constexpr std::size_t max_work = std::size_t{1} << 24;

  /// Calls `use` with the cells of every region that has triangles. Returns false if the pixel is given up, because of
  /// `use` or because it has too many cells; `use` was then not called for all regions.
  bool find(std::span<const PixelTriangle> triangles, const Use& use);

 private:
  /// A triangle that overlaps a region.
  struct Member {
    std::uint32_t number;
    bool covers;
    double min_depth, max_depth;
  };
  /// The number of cutting triangles in a region's parent, and the number of successive divisions that hardly reduced
  /// it.
  struct Crowd {
    std::size_t cutters = 0;
    int in_vain = 0;
  };

  bool find_in(const ConvexPolygon& square, std::size_t level, Crowd above, const Use& use);
  bool insert(const PixelTriangle& triangle);
  void gather(const ConvexPolygon& square, std::size_t level);
  std::size_t count_cutters(std::size_t level);

  std::span<const PixelTriangle> triangles_;
  std::vector<std::vector<Member>> members_;  ///< by level
  std::vector<Member> covering_;              ///< members that cover the current region, nearest first
  PixelCells cells_;
  std::size_t work_ = 0;  ///< work done for the pixel
};

}  // namespace zoneplate::antialias
