// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Pixels at the border of axis-parallel edges: what crosses the ends of each edge, and the distances to the ends.
///
/// Units     `from` and `to` are 1 for an edge that crosses the first or last end above the border, −1 below it, and 0
///           for none or both.
struct EdgePixels {
  const float *from, *to;
  const float *left, *right;  ///< pixels of the edge before and after this one
  const float* is_corner;     ///< 1 if one of the edges that cross is longer than a pixel, otherwise 0
};

/// Pixels of diagonals that rise to the right.
struct DiagonalPixels {
  const std::int32_t* lines;  ///< of the pattern (diagonal_lines_of)
  const float *left, *right;
};

/// The areas of pixels under SMAA's revectorised edges, in closed form, for a sample anywhere in the pixel.
///
/// A line through the samples' edges is displaced by the sample's offset from the pixel's centre, along the edge as
/// well as across it. Within the pixel and its neighbour across the border the area is that under the line, which
/// continues beyond the ends of the edge.
///
/// Units     `offset` in pixels, in [−0.5, 0.5]: `offset.x` along the edge or to the right; `offset.y` upwards.
/// Exact     within 1e-5 of the integral.
/// Source    the patterns and the smoothing of short U shapes are those of SMAA's AreaTex.py 2.8. Its areas for samples
///           off the centre are not: these ignore the offset along the edge, mix every step with two half steps, and do
///           not move the lines of diagonals at ends of an unknown kind.
struct AreaKernels : PerIsa<AreaKernels> {
  /// Computes the areas below and above the border.
  void (*orthogonal)(const EdgePixels& pixels, float2 offset, float* below, float* above, std::size_t n);
  /// Computes the areas of the pixel below the border, which is right of the diagonal, and of the one above.
  void (*diagonal)(const DiagonalPixels& pixels, float2 offset, float* below, float* above, std::size_t n);
};

}  // namespace zoneplate
