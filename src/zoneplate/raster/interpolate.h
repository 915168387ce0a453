#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/raster/batch.h"
#include "zoneplate/raster/project.h"

namespace zoneplate {

/// The perspective-correct barycentric weights of a triangle, as functions of the point on the screen:
/// b_k = q_k / (q_0 + q_1 + q_2) with q_k = x[k] P.x + y[k] P.y + one[k].
///
/// Units     P in 1/256 pixel from the picture's centre.
/// Source    E_k / w_k of the snapped vertices; for a triangle that crosses the eye's plane the 2D homogeneous form,
/// which
///           needs no division: Olano and Greer, Triangle Scan Conversion using 2D Homogeneous Coordinates, 1997.
struct BarycentricPlanes {
  double x[3], y[3], one[3];
};

/// Exact     E_k is exact; its product with inv_w is rounded once.
BarycentricPlanes barycentric_planes(const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r);

/// For a triangle that has a vertex outside the near plane, the far plane or the guard band.
BarycentricPlanes barycentric_planes(float4 p, float4 q, float4 r, Viewport viewport);

/// The planes of a batch's points, structure of arrays; or, of 8 points of one triangle, once.
struct BatchPlanes {
  bool is_shared[Batch::capacity / Batch::group];
  BarycentricPlanes shared[Batch::capacity / Batch::group];
  alignas(64) double x[3][Batch::capacity], y[3][Batch::capacity], one[3][Batch::capacity];
};

struct InterpolateKernels {
  /// Fills b, dbdx, dbdy of all padded() entries. Weights are clamped to [0, 1]: no attribute is extrapolated.
  /// dbdx and dbdy are per `spacing` pixels.
  void (*interpolate)(const BatchPlanes& planes, Viewport viewport, float spacing, Batch& batch);
};

namespace scalar {
extern const InterpolateKernels interpolate_kernels;
}
namespace N_SSE4 {
extern const InterpolateKernels interpolate_kernels;
}
namespace N_AVX2 {
extern const InterpolateKernels interpolate_kernels;
}
inline const InterpolateKernels& interpolate_kernels(Isa isa) {
  return pick(isa, scalar::interpolate_kernels, N_SSE4::interpolate_kernels, N_AVX2::interpolate_kernels);
}

}  // namespace zoneplate
