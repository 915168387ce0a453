// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/sdf/program.h"

namespace zoneplate::sdf {

/// Shapes with colours, painted one over the other.
struct Drawing {
  struct Layer {
    ShapeCode shape;
    Linear color;  ///< premultiplied
  };
  Program program;
  std::vector<Layer> layers;

  void fill(const ShapePtr& shape, const Linear& color) { layers.push_back({program.add(shape), color}); }
};

/// The pixels of a drawing: the centre of pixel (i, j) is at origin + (i + ½, j + ½) / scale.
struct Raster {
  int width = 0, height = 0;
  Point origin;
  double scale = 1;  ///< pixels per unit

  Point centre(double column, double row) const {
    return {origin.x + (column + 0.5) / scale, origin.y + (row + 0.5) / scale};
  }
};

/// Draws the layers over a background.
///
/// Each pixel is divided into grid × grid squares. The coverage of a square is the area of the half-plane that has the
/// distance and the gradient at its centre; it is exact where one straight edge crosses the square.
///
/// Requires  1 <= grid <= 16.
/// Exact     the same bits for every number of threads and instruction set.
/// Cost      a shape is evaluated in the 8 × 8 blocks of its bounds whose pixels its boundary may cross.
LinearImage draw(const Drawing& drawing, const Raster& raster, const Linear& background, int grid = 1);

/// The coverage of one shape; 1 inside.
Plane<float> coverage_of(const ShapePtr& shape, const Raster& raster, int grid = 1);

/// The signed distance at every pixel's centre, in units of the shape, and its gradient.
struct DistanceField {
  Plane<float> distance;
  Plane<float> gradient_x, gradient_y;
};
DistanceField distance_field(const ShapePtr& shape, const Raster& raster);

/// The distances of a shape at any points, for measurements.
std::vector<float> distances_at(const ShapePtr& shape, std::span<const Point> points);

}  // namespace zoneplate::sdf
