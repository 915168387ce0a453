// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/raster/geometry/project.h"
#include "zoneplate/raster/geometry/triangle_facing.h"
#include "zoneplate/raster/types/batch.h"

namespace zoneplate {

/// The vertices of a batch's triangles. In a flat run only the leader's entries are set (FragmentBatch).
struct BatchTriangles {
  /// If not null, all vertices are screen[batch.vertex], and `vertex` is undefined. Requires: no flat runs.
  const ScreenVertex* screen = nullptr;
  const ScreenVertex* vertex[3][FragmentBatch::padded_capacity];
  alignas(64) std::int32_t is_mirrored[FragmentBatch::padded_capacity];  ///< 1: front faces are clockwise; else 0

  /// Vertex k of the triangle whose values entry i holds.
  const ScreenVertex& of(std::size_t k, std::size_t i, const FragmentBatch& batch) const {
    return screen ? screen[batch.vertex[k][i]] : *vertex[k][i];
  }
};

/// The barycentric planes of 8 fragments, and the weights and derivatives computed from them.
struct ClippedGroup {
  alignas(64) double x[3][FragmentBatch::group], y[3][FragmentBatch::group], one[3][FragmentBatch::group];
  alignas(64) std::int32_t px[FragmentBatch::group], py[FragmentBatch::group];  ///< as in FragmentBatch
  alignas(64) float b[2][FragmentBatch::group], dbdx[2][FragmentBatch::group], dbdy[2][FragmentBatch::group];
};

/// b_k = q_k / (q_0 + q_1 + q_2) with q_k = E_k / w_k, where E_k is the edge function opposite to vertex k; and the
/// change of b_k per `spacing` pixels, but only if `spacing` is not 0. Weights are clamped: no attribute is
/// extrapolated. If the vertices of a triangle have one w, as those of an orthographic camera have, w is left out: then
/// q_k = E_k, and the sum of the q_k and the derivatives of b_k are constant over the triangle.
struct InterpolateKernels : PerIsa<InterpolateKernels> {
  /// Fills b, dbdx, dbdy, has_uniform_derivatives and is_front of all padded() entries from the snapped vertices, and x
  /// and y of flat groups from those of their first fragments. Returns a bit for each group in which a triangle needs
  /// clipping; the values of such a triangle's fragments are undefined.
  ///
  /// Exact     E_k is an exact integer, and the sign of their sum is the visible side.
  std::uint32_t (*interpolate)(const BatchTriangles& triangles, Viewport viewport, float spacing, FragmentBatch& batch);

  /// The same for fragments of triangles that cross the eye's plane.
  void (*interpolate_clipped)(Viewport viewport, float spacing, ClippedGroup& group);
  /// The same for fragments [first, last) of one such triangle, in whole groups whose x and y are set: fills b, dbdx
  /// and dbdy.
  void (*interpolate_clipped_rows)(const BarycentricPlanes& planes, Viewport viewport, float spacing,
                                   FragmentBatch& batch, int first, int last);
};

}  // namespace zoneplate
