// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/fragment/interpolate.h"

#include <algorithm>
#include <cmath>

namespace zoneplate {

namespace scalar {
namespace {

/// Clamps a weight to [0, limit]. Adding +0 turns -0 into +0, so that all instruction sets give the same bits.
float clamped(float b, float limit) { return std::min(std::max(b, 0.0f), limit) + 0.0f; }

std::uint32_t interpolate(const BatchTriangles& triangles, Viewport viewport, float spacing, FragmentBatch& batch) {
  const float step = 256.0f * spacing;
  std::uint32_t clipped = 0;
  for (int i = 0; i < batch.padded(); ++i) {
    const int in_group = i % FragmentBatch::group, first = i - in_group;
    if (batch.is_flat_run[i / FragmentBatch::group])
      batch.x[i] = batch.x[first] + 256 * in_group, batch.y[i] = batch.y[first];
    const std::size_t leader = batch.leader(static_cast<std::size_t>(i));
    std::int32_t dx[3], dy[3];
    float inv_w[3];
    for (int k = 0; k < 3; ++k) {
      const ScreenVertex& v = triangles.of(static_cast<std::size_t>(k), leader, batch);
      dx[k] = v.x - (batch.x[i] - viewport.width * 128), dy[k] = v.y - (batch.y[i] - viewport.height * 128);
      inv_w[k] = v.inv_w;
      if (v.needs_clipping()) clipped |= 1u << (i / FragmentBatch::group);
    }
    const bool is_affine = inv_w[0] == inv_w[1] && inv_w[1] == inv_w[2] && inv_w[0] != 0;
    if (is_affine) inv_w[0] = inv_w[1] = inv_w[2] = 1;
    batch.has_uniform_derivatives[i / FragmentBatch::group] = is_affine && leader < static_cast<std::size_t>(first);
    double edge[3];
    float q[3], gx[3], gy[3];
    for (int k = 0; k < 3; ++k) {
      const int m = (k + 1) % 3, n = (k + 2) % 3;
      edge[k] = double{1} * dx[m] * dy[n] - double{1} * dy[m] * dx[n];
      q[k] = static_cast<float>(edge[k]) * inv_w[k];
      gx[k] = static_cast<float>(dy[m] - dy[n]) * inv_w[k];
      gy[k] = static_cast<float>(dx[n] - dx[m]) * inv_w[k];
    }
    const double area = (edge[0] + edge[1]) + edge[2];
    const std::int32_t is_clockwise = area > 0 ? 1 : 0;
    if (leader == static_cast<std::size_t>(i)) batch.is_front[i] = is_clockwise == triangles.is_mirrored[i] ? 1 : 0;
    const float sum = is_affine ? static_cast<float>(area) : (q[0] + q[1]) + q[2];
    const float inverse = 1.0f / (sum == 0 ? 1.0f : sum);
    const float b1 = clamped(q[1] * inverse, 1.0f), b2 = clamped(q[2] * inverse, 1.0f - b1);
    batch.b[0][i] = b1, batch.b[1][i] = b2;
    if (spacing == 0) continue;
    const float sum_x = is_affine ? 0 : (gx[0] + gx[1]) + gx[2], sum_y = is_affine ? 0 : (gy[0] + gy[1]) + gy[2];
    const float by = inverse * step;
    batch.dbdx[0][i] = (gx[1] - b1 * sum_x) * by, batch.dbdx[1][i] = (gx[2] - b2 * sum_x) * by;
    batch.dbdy[0][i] = (gy[1] - b1 * sum_y) * by, batch.dbdy[1][i] = (gy[2] - b2 * sum_y) * by;
  }
  return clipped;
}

/// The weights of the second and the third vertex, and their derivatives.
struct ClippedPoint {
  float b[2], dbdx[2], dbdy[2];
};

ClippedPoint interpolate_point(const BarycentricPlanes& t, double px, double py, float spacing) {
  float q[3], gx[3], gy[3];
  for (int k = 0; k < 3; ++k) {
    q[k] = static_cast<float>(t.x[k] * px + (t.y[k] * py + t.one[k]));
    gx[k] = static_cast<float>(t.x[k]), gy[k] = static_cast<float>(t.y[k]);
  }
  const float sum = (q[0] + q[1]) + q[2], inverse = 1.0f / (sum == 0 ? 1.0f : sum);
  const float sum_x = (gx[0] + gx[1]) + gx[2], sum_y = (gy[0] + gy[1]) + gy[2], by = inverse * (256.0f * spacing);
  float limit = 1;
  ClippedPoint p;
  for (int k = 0; k < 2; ++k) {
    p.b[k] = clamped(q[k + 1] * inverse, limit);
    limit = limit - p.b[k];
    p.dbdx[k] = (gx[k + 1] - p.b[k] * sum_x) * by;
    p.dbdy[k] = (gy[k + 1] - p.b[k] * sum_y) * by;
  }
  return p;
}

void interpolate_clipped(Viewport viewport, float spacing, ClippedGroup& g) {
  for (int i = 0; i < FragmentBatch::group; ++i) {
    BarycentricPlanes t;
    for (int k = 0; k < 3; ++k) t.x[k] = g.x[k][i], t.y[k] = g.y[k][i], t.one[k] = g.one[k][i];
    const ClippedPoint p =
        interpolate_point(t, g.px[i] - viewport.width * 128, g.py[i] - viewport.height * 128, spacing);
    for (int k = 0; k < 2; ++k) {
      g.b[k][i] = p.b[k];
      if (spacing != 0) g.dbdx[k][i] = p.dbdx[k], g.dbdy[k][i] = p.dbdy[k];
    }
  }
}

void interpolate_clipped_rows(const BarycentricPlanes& planes, Viewport viewport, float spacing, FragmentBatch& batch,
                              int first, int last) {
  for (int i = first; i < last; ++i) {
    const ClippedPoint p =
        interpolate_point(planes, batch.x[i] - viewport.width * 128, batch.y[i] - viewport.height * 128, spacing);
    for (int k = 0; k < 2; ++k) {
      batch.b[k][i] = p.b[k];
      if (spacing != 0) batch.dbdx[k][i] = p.dbdx[k], batch.dbdy[k][i] = p.dbdy[k];
    }
  }
}

}  // namespace

}  // namespace scalar

template <>
const InterpolateKernels PerIsa<InterpolateKernels>::scalar = {
    .interpolate = scalar::interpolate,
    .interpolate_clipped = scalar::interpolate_clipped,
    .interpolate_clipped_rows = scalar::interpolate_clipped_rows};
}  // namespace zoneplate
