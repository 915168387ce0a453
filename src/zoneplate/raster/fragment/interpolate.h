#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/raster/geometry/project.h"
#include "zoneplate/raster/geometry/triangle_facing.h"
#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// The corners of a batch's triangles; where a group shares its triangle, where it is told (FragmentBatch) only.
struct BatchTriangles {
  /// Not null: all are screen[batch.vertex], and `vertex` says nothing. Requires: no group shares its triangle.
  const ScreenVertex* screen = nullptr;
  const ScreenVertex* vertex[3][FragmentBatch::padded_capacity];
  alignas(64) std::int32_t is_mirrored[FragmentBatch::padded_capacity];  ///< 1: front faces are clockwise; else 0

  /// Corner k of what is told at point i.
  const ScreenVertex& of(std::size_t k, std::size_t i, const FragmentBatch& batch) const {
    return screen ? screen[batch.vertex[k][i]] : *vertex[k][i];
  }
};

/// The planes of 8 points, and the weights and derivatives that come out of them.
struct ClippedGroup {
  alignas(64) double x[3][FragmentBatch::group], y[3][FragmentBatch::group], one[3][FragmentBatch::group];
  alignas(64) std::int32_t px[FragmentBatch::group], py[FragmentBatch::group];  ///< as in FragmentBatch
  alignas(64) float b[2][FragmentBatch::group], dbdx[2][FragmentBatch::group], dbdy[2][FragmentBatch::group];
};

/// b_k = q_k / (q_0 + q_1 + q_2) with q_k = E_k / w_k, where E_k is the edge function opposite to vertex k; and the
/// change of b_k per `spacing` pixels, but only if `spacing` is not 0. Weights are clamped: no attribute is
/// extrapolated. Where a triangle's corners have one w, as all have of an orthographic camera, w is left out: the sum
/// of the q_k = E_k is then the same at all points, and so is the change of b_k.
struct InterpolateKernels : PerIsa<InterpolateKernels> {
  /// Fills b, dbdx, dbdy, has_uniform_derivatives and is_front of all padded() entries from the snapped vertices, and x
  /// and y of groups that share their triangle from those of their first points. Gives the groups in which a triangle
  /// needs clipping, a bit each; for its points the result says nothing.
  ///
  /// Exact     E_k is an exact integer, and so is the sign of their sum, the side that is seen.
  std::uint32_t (*interpolate)(const BatchTriangles& corners, Viewport viewport, float spacing, FragmentBatch& batch);

  /// The same for points of triangles that cross the eye's plane.
  void (*interpolate_clipped)(Viewport viewport, float spacing, ClippedGroup& group);
  /// The same for points [first, last) of one such triangle, in whole groups whose x and y are set: fills b, dbdx and
  /// dbdy.
  void (*interpolate_clipped_rows)(const BarycentricPlanes& planes, Viewport viewport, float spacing,
                                   FragmentBatch& batch, int first, int last);
};

}  // namespace zoneplate
