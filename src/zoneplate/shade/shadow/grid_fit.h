// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// The visibility of a light at pixels about a cell of a VisibilityGrid, and what they show.
struct GridNeighbours {
  static constexpr int width = 4;         ///< cells along one axis, of which the second is the receivers' own
  static constexpr int max_per_cell = 2;  ///< pixels
  static constexpr int capacity = width * width * max_per_cell;
  static constexpr float nothing = -1;  ///< no surface
  static constexpr float unlit = -2;    ///< a surface that does not face the light

  int count = 0;
  float x[capacity], y[capacity];  ///< along the axes of the lattice, from the cell's point
  float position[3][capacity], normal[3][capacity];
  float bend[capacity];  ///< the square of the sine of the angle between the normals of the vertices and the triangle
  std::int32_t surface[capacity];
  float visible[capacity];
};

/// Receivers in one cell, as in Receivers.
struct GridReceivers {
  static constexpr int capacity = FragmentBatch::padded_capacity;
  int count = 0;
  alignas(64) float u[capacity], v[capacity];  ///< in the cell, from its point
  alignas(64) float position[3][capacity], normal[3][capacity], bend[capacity];
  alignas(64) std::int32_t surface[capacity];
};

/// How well the neighbours describe a surface.
struct GridDensity {
  float noise = 0;       ///< the variance of a visibility of 1/2 by its rays, times 4
  bool has_gaps = true;  ///< pixels between the neighbours may show what they do not
};

/// Interpolation on surfaces by moving least squares (visibility_grid.h).
struct GridFitKernels : PerIsa<GridFitKernels> {
  /// Stores the visibility at each receiver, GridNeighbours::nothing where it is not determined.
  void (*fit)(const GridNeighbours& near, const GridReceivers& receivers, const GridDensity& density, float* visible);
};

}  // namespace zoneplate
