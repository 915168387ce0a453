#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "zoneplate/antialias/reference/analytic/cells.h"

namespace zoneplate::antialias {

/// Finds what is visible in a pixel, a region at a time: a crowded pixel is quartered, and crowded quarters again, so
/// that each triangle meets only what is near it. Triangles that cover a region in one order, however many, are no
/// crowd: they cut nothing.
///
/// Exact     as PixelCells: the regions' polygons together fill the pixel. Whether a region is quartered depends on the
///           triangles' places alone.
/// Cost      with n triangles that are seen, near n log n in place of n². A pixel that would need more than `most_work`
///           is given up.
class PixelRegions {
 public:
  /// Returns false to give the pixel up.
  using Use = std::function<bool(const PixelCells&)>;

  static constexpr std::size_t most_work = std::size_t{1}
                                           << 24;  ///< cells that triangles are compared with, and layers in four

  /// Calls `use` with the cells of every region that has triangles. False if the pixel is given up, because of `use` or
  /// because its cells are too many; what was given to `use` is then not all.
  bool find(std::span<const PixelTriangle> triangles, const Use& use);

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

  bool find_in(const ConvexPolygon& square, std::size_t level, Crowd above, const Use& use);
  bool insert(const PixelTriangle& triangle);
  void gather(const ConvexPolygon& square, std::size_t level);
  std::size_t count_cutters(std::size_t level);

  std::span<const PixelTriangle> triangles_;
  std::vector<std::vector<Member>> members_;  ///< by level
  std::vector<Member> covering_;              ///< of the region at work, nearest first
  PixelCells cells_;
  std::size_t work_ = 0;  ///< done for the pixel
};

}  // namespace zoneplate::antialias
