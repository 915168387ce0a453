#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "zoneplate/antialias/analytic_cells.h"

namespace zoneplate::antialias {

/// Finds what is visible in a pixel, a region at a time: a crowded pixel is quartered, and crowded quarters again, so
/// that each triangle meets only what is near it. Triangles that cover a region in one order, however many, are no
/// crowd: they cut nothing.
///
/// Exact     as PixelCells: the regions' polygons together fill the pixel. Whether a region is quartered depends on the
///           triangles' places alone.
/// Cost      with n triangles that are seen, near n log n in place of n².
class PixelRegions {
 public:
  using Use = std::function<void(const PixelCells&)>;

  /// Calls `use` with the cells of every region that has triangles.
  void find(std::span<const PixelTriangle> triangles, const Use& use);

 private:
  /// A triangle within a region.
  struct Member {
    std::uint32_t number;
    bool covers;
    double least_depth, greatest_depth;
  };
  /// How many triangles cut what is above a region, and how often quartering has hardly lessened them.
  struct Crowd {
    std::size_t cutters = 0;
    int in_vain = 0;
  };

  void find_in(const ConvexPolygon& square, std::size_t level, Crowd above, const Use& use);
  void gather(const ConvexPolygon& square, std::size_t level);
  std::size_t count_cutters(std::size_t level);

  std::span<const PixelTriangle> triangles_;
  std::vector<std::vector<Member>> members_;  ///< by level
  std::vector<Member> covering_;              ///< of the region at work, nearest first
  PixelCells cells_;
};

}  // namespace zoneplate::antialias
