#include "zoneplate/raster/interpolate.h"

#include <algorithm>

namespace zoneplate {

BarycentricPlanes barycentric_planes(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r) {
  const ScreenVertex* v[3] = {&p, &q, &r};
  BarycentricPlanes out;
  for (int k = 0; k < 3; ++k) {
    const ScreenVertex &from = *v[(k + 1) % 3], &to = *v[(k + 2) % 3];
    const double inv_w = v[k]->inv_w;
    const double x1 = from.x, y1 = from.y, x2 = to.x, y2 = to.y;
    out.x[k] = (y1 - y2) * inv_w;
    out.y[k] = (x2 - x1) * inv_w;
    out.one[k] = (x1 * y2 - y1 * x2) * inv_w;
  }
  return out;
}

BarycentricPlanes barycentric_planes(float4 p, float4 q, float4 r, Viewport viewport) {
  const float4 v[3] = {p, q, r};
  BarycentricPlanes out;
  for (int k = 0; k < 3; ++k) {
    const float4 &from = v[(k + 1) % 3], &to = v[(k + 2) % 3];
    const double sx = viewport.width * 128, sy = viewport.height * -128;
    const double x1 = static_cast<double>(from.x) * sx, y1 = static_cast<double>(from.y) * sy, w1 = from.w;
    const double x2 = static_cast<double>(to.x) * sx, y2 = static_cast<double>(to.y) * sy, w2 = to.w;
    out.x[k] = y1 * w2 - w1 * y2;
    out.y[k] = w1 * x2 - x1 * w2;
    out.one[k] = x1 * y2 - y1 * x2;
  }
  return out;
}

namespace scalar {
namespace {

void interpolate(const BatchPlanes& planes, Viewport viewport, float spacing, Batch& batch) {
  const double step = 256.0 * static_cast<double>(spacing);
  for (int i = 0; i < batch.padded(); ++i) {
    const double px = batch.x[i] - viewport.width * 128, py = batch.y[i] - viewport.height * 128;
    const int group = i / Batch::group;
    BarycentricPlanes p;
    for (int k = 0; k < 3; ++k) p.x[k] = planes.x[k][i], p.y[k] = planes.y[k][i], p.one[k] = planes.one[k][i];
    if (planes.is_shared[group]) p = planes.shared[group];
    double q[3];
    for (int k = 0; k < 3; ++k) q[k] = (p.x[k] * px + p.y[k] * py) + p.one[k];
    const double sum = (q[0] + q[1]) + q[2];
    const double inverse = 1.0 / (sum == 0 ? 1.0 : sum);
    const double sum_x = (p.x[0] + p.x[1]) + p.x[2];
    const double sum_y = (p.y[0] + p.y[1]) + p.y[2];
    for (int k = 0; k < 3; ++k) {
      // Adding +0 makes a weight of -0 the +0 that every instruction set agrees on.
      const double b = std::min(std::max(q[k] * inverse, 0.0), 1.0) + 0.0;
      batch.b[k][i] = static_cast<float>(b);
      batch.dbdx[k][i] = static_cast<float>((p.x[k] - b * sum_x) * inverse * step);
      batch.dbdy[k][i] = static_cast<float>((p.y[k] - b * sum_y) * inverse * step);
    }
  }
}

}  // namespace

const InterpolateKernels interpolate_kernels = {.interpolate = interpolate};

}  // namespace scalar
}  // namespace zoneplate
