// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/antialias/reference/analytic/cells.h"
#include "zoneplate/antialias/reference/analytic/triangles.h"

namespace zoneplate::antialias {

/// A rectangle of pixels of the image.
struct PixelRect {
  int left = 0, top = 0, right = 0, bottom = 0;  ///< right and bottom are exclusive

  int width() const { return right - left; }
  int height() const { return bottom - top; }
  bool contains(int x, int y) const { return x >= left && x < right && y >= top && y < bottom; }
};

/// For each pixel of a rectangle, the triangles that may be visible in it, in an order independent of their ids.
///
/// A triangle is listed if it has area within the pixel and is not entirely behind an opaque one that covers the pixel.
/// Whether a triangle covers the pixel is computed with exact integers.
class PixelCandidates {
 public:
  struct Candidate {
    std::uint32_t pixel;     ///< within the rectangle, row by row
    std::uint32_t triangle;  ///< index into the list of triangles
    bool covers_pixel;
    double max_depth;  ///< upper bound of the triangle's depths in the pixel
  };

  void find(std::span<const ScreenTriangle> triangles, const PixelRect& rect);

  std::span<const Candidate> of_pixel(std::uint32_t pixel) const {
    return std::span(sorted_).subspan(first_[pixel], first_[pixel + 1] - first_[pixel]);
  }

 private:
  void collect_pixels(std::uint32_t number, const ScreenTriangle& triangle, const PixelRect& rect);
  void sort_by_pixel(std::size_t pixels);

  std::vector<std::uint32_t> order_;
  std::vector<Candidate> found_, sorted_;
  std::vector<std::uint32_t> first_, next_;
  std::vector<double> hidden_below_;  ///< for each pixel: the least depth of the nearest opaque triangle that covers it
};

/// The triangle relative to the pixel (x, y).
PixelTriangle at_pixel(const ScreenTriangle& triangle, bool covers_pixel, int x, int y);

}  // namespace zoneplate::antialias
