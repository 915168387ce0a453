#pragma once

#include "zoneplate/shade/lighting.h"
#include "zoneplate/shade/points.h"

namespace zoneplate {

/// From where the points are seen.
struct Viewpoint {
  float eye[3] = {0, 0, 0};
  float towards[3] = {0, 0, 1};  ///< unit direction to an orthographic camera
  bool is_orthographic = false;
};

/// A linear map of texture coordinates: u' = (u m[0] + v m[1]) + m[2], v' = (u m[3] + v m[4]) + m[5].
struct CoordinateMap {
  float m[6] = {1, 0, 0, 0, 1, 0};
  bool operator==(const CoordinateMap&) const = default;
};

/// A use of texture coordinates and their derivatives: u, v; du/dx, dv/dx; du/dy, dv/dy.
struct Coordinates {
  alignas(64) float uv[2][Points::capacity], dx[2][Points::capacity], dy[2][Points::capacity];
};

/// The stages between the vertices and the colour; each acts on all of a batch's points, entry by entry.
///
/// Requires  counts are multiples of 8, at most Points::capacity.
struct SurfaceKernels {
  // Arithmetic on single arrays: out = in × factor + offset; values ×= by; out = value; values clamped to [0, 1].
  void (*scale)(float* out, const float* in, float factor, float offset, int count);
  void (*multiply)(float* values, const float* by, int count);
  void (*fill)(float* out, float value, int count);
  void (*saturate)(float* values, int count);

  /// value = (b0 a0 + b1 a1) + b2 a2, and the same with dbdx and dbdy.
  void (*interpolate)(const Batch& batch, const Corners& corners, const Interpolation& what, int count);
  void (*map_coordinates)(const CoordinateMap& map, const Points& points, int set, Coordinates& out);

  // From object to world space, by each point's own placement; normals and tangents are not normalised.
  void (*place_positions)(const Batch& batch, const Corners& corners, const Placement* placements, Points& points);
  void (*place_normals)(const Batch& batch, const Corners& corners, const Placement* placements, Points& points);
  void (*place_tangents)(const Batch& batch, const Corners& corners, const Placement* placements, Points& points);
  void (*look_back)(const Viewpoint& viewpoint, Points& points);  ///< to_viewer

  /// Normalises; turns the normals of back faces round.
  void (*face_normals)(const Batch& batch, Points& points);
  /// The same after bending them by a normal map: n = T x + B y + N z with (x, y, z) = 2 texel - 1, x and y × scale,
  /// and B = (N × T) × the sign of tangent.w. Points without a tangent keep their normal. Source: glTF 2.0, 3.9.3.
  void (*bend_normals)(const Batch& batch, const float* const texel[4], float scale, Points& points);
  /// Points without a normal get the direction to the viewer.
  void (*default_normals)(Points& points);

  void (*reach_light)(const PreparedLight& light, Points& points);  ///< to_light, strength
  // Add the light at hand: to `diffuse`; to `diffuse` and `specular`; to `sum`.
  void (*add_lambert)(const PreparedLight& light, Points& points);
  void (*add_blinn_phong)(const PreparedLight& light, float exponent, Points& points);
  void (*add_phong)(const PreparedLight& light, float exponent, Points& points);
  void (*add_metallic)(const PreparedLight& light, Points& points);
  void (*add_environment)(const float radiance[3], Points& points);  ///< times occlusion, to `sum`

  /// sum = base (ambient × occlusion + diffuse), and + specular colour × specular.
  void (*combine_diffuse)(const float ambient[3], Points& points);
  void (*add_specular)(const float color[3], Points& points);
  void (*add_emissive)(Points& points);  ///< sum += emissive
  void (*keep_unlit)(Points& points);    ///< sum = base where not is_lit

  /// Colour × alpha, colour clamped to [0, 1e9] and so always finite. `alpha` null: opaque.
  void (*finish)(const float* const color[3], const float* alpha, Shaded& out, int count);
};

namespace scalar {
extern const SurfaceKernels surface_kernels;
}
namespace N_SSE4 {
extern const SurfaceKernels surface_kernels;
}
namespace N_AVX2 {
extern const SurfaceKernels surface_kernels;
}

}  // namespace zoneplate
