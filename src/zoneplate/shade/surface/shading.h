#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/shade/surface/exponent.h"
#include "zoneplate/shade/surface/lighting.h"
#include "zoneplate/shade/surface/points.h"

namespace zoneplate {

/// From where the points are seen.
struct Viewpoint {
  float eye[3] = {0, 0, 0};
  float towards[3] = {0, 0, 1};  ///< unit direction to an orthographic camera
  bool is_orthographic = false;
  bool has_rays = false;  ///< the way to the viewer is known by pixel: ray + x ray_dx + y ray_dy, of any length
  float ray[3] = {}, ray_dx[3] = {}, ray_dy[3] = {};
};

/// A material under a scene's lights. What has a texture is read from the points.
struct ShadingUniforms {
  const PreparedLight* light = nullptr;
  int lights = 0;
  Viewpoint viewpoint;
  bool needs_viewer = false;
  bool has_occlusion = false;  ///< a texture
  bool has_emissive = false, has_emissive_texture = false;
  bool has_bare_meshes = false, is_blended = false;
  float emissive[3] = {0, 0, 0};

  // (Blinn-)Phong.
  bool has_specular = false, is_phong = false;
  float ambient[3] = {0, 0, 0}, specular[3] = {0, 0, 0};
  Exponent exponent;

  // Metallic-roughness.
  bool has_material_texture = false, has_environment = false;
  float metallic = 1, roughness = 1;
  float environment[3] = {0, 0, 0};  ///< radiance from all sides
};

/// A linear map of texture coordinates: u' = (u m[0] + v m[1]) + m[2], v' = (u m[3] + v m[4]) + m[5].
struct CoordinateMap {
  float m[6] = {1, 0, 0, 0, 1, 0};
  bool operator==(const CoordinateMap&) const = default;
};

/// A use of texture coordinates and their derivatives: u, v; du/dx, dv/dx; du/dy, dv/dy. The derivatives of groups that
/// repeat their derivatives (FragmentBatch) are not set.
struct Coordinates {
  alignas(64) float uv[2][FragmentBatch::padded_capacity], dx[2][FragmentBatch::padded_capacity],
      dy[2][FragmentBatch::padded_capacity];
};

/// The stages between the vertices and the colour; each acts on all of a batch's points, entry by entry.
///
/// Requires  counts are multiples of 8, at most ShadingState::capacity; arrays have room up to the next multiple of
///           FragmentBatch::max_lanes.
struct SurfaceKernels : PerIsa<SurfaceKernels> {
  // Arithmetic on single arrays: out = in × factor + offset; values ×= by; out = value; values clamped to [0, 1].
  void (*scale)(float* out, const float* in, float factor, float offset, int count);
  void (*multiply)(float* values, const float* by, int count);
  void (*fill)(float* out, float value, int count);
  void (*saturate)(float* values, int count);

  // Changes of coordinates are left out where the batch repeats its derivatives.
  /// value = a0 + ((a1 - a0) b1 + (a2 - a0) b2), and the same without the first term with dbdx and dbdy.
  void (*interpolate)(const FragmentBatch& batch, const TriangleVertices& corners, const Interpolation& what,
                      ShadingState& points);
  void (*map_coordinates)(const CoordinateMap& map, const FragmentBatch& batch, const ShadingState& points, int set,
                          Coordinates& out);

  // From object to world space, by each point's own placement; normals and tangents are not normalised.
  void (*place_positions)(const FragmentBatch& batch, const TriangleVertices& corners,
                          const InstanceTransform* placements, ShadingState& points);
  void (*place_normals)(const FragmentBatch& batch, const TriangleVertices& corners,
                        const InstanceTransform* placements, ShadingState& points);
  void (*place_tangents)(const FragmentBatch& batch, const TriangleVertices& corners,
                         const InstanceTransform* placements, ShadingState& points);

  /// From interpolated to shading normals: placed, normalised, those of back faces turned round.
  void (*find_normals)(const FragmentBatch& batch, const TriangleVertices& corners, const InstanceTransform* placements,
                       ShadingState& points);
  /// The same for placed ones, bent by a normal map: n = T x + B y + N z with (x, y, z) = 2 texel - 1, x and y × scale,
  /// and B = (N × T) × the sign of tangent.w. ShadingState without a tangent keep their normal. Source:
  /// glTF 2.0, 3.9.3.
  void (*bend_normals)(const FragmentBatch& batch, const float* const texel[4], float scale, ShadingState& points);
  /// ShadingState without a normal get the direction to the viewer.
  void (*default_normals)(const Viewpoint& viewpoint, const FragmentBatch& batch, ShadingState& points);

  // From the material to the colour: × alpha where it is blended, clamped to [0, 1e9] and so always finite.
  /// base (ambient × occlusion + diffuse) + specular colour × specular + emissive.
  void (*light_phong)(const ShadingUniforms& what, const FragmentBatch& batch, const ShadingState& points,
                      FragmentOutputs& out);
  /// The lights' metallic-roughness reflections + occlusion × that of the environment + emissive.
  void (*light_metallic)(const ShadingUniforms& what, const FragmentBatch& batch, const ShadingState& points,
                         FragmentOutputs& out);
  void (*unlit)(bool is_blended, const ShadingState& points, FragmentOutputs& out);
};

}  // namespace zoneplate
