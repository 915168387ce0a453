// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/scene/light.h"
#include "zoneplate/shade/reflection/exponent.h"
#include "zoneplate/shade/surface/layered.h"
#include "zoneplate/shade/surface/lighting.h"
#include "zoneplate/shade/surface/shading_state.h"

namespace zoneplate {

struct BackdropView;
struct EnvironmentView;

/// The position or direction of the viewer.
struct Viewpoint {
  float eye[3] = {0, 0, 0};
  float towards[3] = {0, 0, 1};  ///< unit direction to an orthographic camera
  bool is_orthographic = false;
  bool has_rays = false;  ///< the vector to the viewer is ray + x ray_dx + y ray_dy at pixel (x, y), of any length
  float ray[3] = {}, ray_dx[3] = {}, ray_dy[3] = {};
};

/// The constants of a material under a scene's lights. Textured parameters are read from the ShadingState instead.
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
  bool has_specular_texture = false, has_exponent_texture = false;
  float ambient[3] = {0, 0, 0}, specular[3] = {0, 0, 0};
  Exponent exponent;

  // Metallic-roughness.
  bool is_metallic = false;
  bool has_material_texture = false, has_environment = false;
  bool has_turning_normals = false;  ///< the lobes of lights are widened by ShadingState::normal_dx and normal_dy
  float metallic = 1, roughness = 1;
  float environment[3] = {0, 0, 0};  ///< radiance from all sides, where `map` is null; not for (Blinn-)Phong
  const EnvironmentView* map = nullptr;
  bool has_pixels = true;  ///< FragmentBatch::x and y are set; else the positions are
  /// Of materials with layers, those that all fragments have; negative where they differ.
  float layered_roughness = -1, coat_roughness = -1;
  const BackdropView* backdrop = nullptr;  ///< what transmissive surfaces refract; null: the environment alone
  bool has_environment_behind = true;      ///< the background is the environment
  bool has_background_color = false;       ///< the background is a colour
  float background[3] = {0, 0, 0};
};

/// A linear map of texture coordinates: u' = (u m[0] + v m[1]) + m[2], v' = (u m[3] + v m[4]) + m[5].
struct CoordinateMap {
  float m[6] = {1, 0, 0, 0, 1, 0};
  bool operator==(const CoordinateMap&) const = default;
};

/// Texture coordinates and their derivatives: u, v; du/dx, dv/dx; du/dy, dv/dy. The derivatives are unset in groups
/// with FragmentBatch::has_uniform_derivatives.
struct Coordinates {
  alignas(64) float uv[2][FragmentBatch::padded_capacity], dx[2][FragmentBatch::padded_capacity],
      dy[2][FragmentBatch::padded_capacity];
};

/// The stages between the vertices and the colour. Each acts on all fragments of a batch, one by one.
///
/// Requires  counts are multiples of 8, at most ShadingState::capacity; arrays extend to the next multiple of
///           FragmentBatch::max_lanes.
struct SurfaceKernels : PerIsa<SurfaceKernels> {
  // Arithmetic on single arrays: out = in × factor + offset; values ×= by; out = value; values clamped to [0, 1].
  void (*scale)(float* out, const float* in, float factor, float offset, int count);
  void (*multiply)(float* values, const float* by, int count);
  void (*fill)(float* out, float value, int count);
  void (*saturate)(float* values, int count);

  // Derivatives of coordinates are left out where the batch repeats them.
  /// value = a0 + ((a1 - a0) b1 + (a2 - a0) b2); the derivatives replace b by dbdx and dbdy and drop the first term.
  void (*interpolate)(const FragmentBatch& batch, const TriangleVertices& vertices, const Interpolation& interpolation,
                      ShadingState& state);
  void (*map_coordinates)(const CoordinateMap& map, const FragmentBatch& batch, const ShadingState& state, int set,
                          Coordinates& out);

  // From object to world space, by the transform of each fragment's instance; normals and tangents are not normalised.
  void (*transform_positions)(const FragmentBatch& batch, const TriangleVertices& vertices,
                              const InstanceTransform* transforms, ShadingState& state);
  void (*transform_normals)(const FragmentBatch& batch, const TriangleVertices& vertices,
                            const InstanceTransform* transforms, ShadingState& state);
  void (*transform_tangents)(const FragmentBatch& batch, const TriangleVertices& vertices,
                             const InstanceTransform* transforms, ShadingState& state);

  /// From interpolated to shading normals: transformed to world space, normalised, reversed on back faces.
  void (*compute_normals)(const FragmentBatch& batch, const TriangleVertices& vertices,
                          const InstanceTransform* transforms, ShadingState& state);
  /// The same for normals in world space, perturbed by a normal map: n = T x + B y + N z with (x, y, z) = 2 texel - 1,
  /// x and y × scale, and B = (N × T) × the sign of tangent.w. Fragments without a tangent keep their normal.
  /// Source: glTF 2.0, 3.9.3.
  void (*bend_normals)(const FragmentBatch& batch, const float* const texel[4], float scale, ShadingState& state);
  /// The variance of the interpolated normal within a pixel, added up over both axes: min((|∂n/∂x|² + |∂n/∂y|²) / 12,
  /// 0.09) for unit normals n in world space; normal_dx and normal_dy become the vectors a and b of TurningLobe, which
  /// hold twice that variance. Before compute_normals or transform_normals.
  /// Source    Tokuyoshi and Kaplanyan, Stable Geometric Specular Antialiasing with Projected-Space NDF Filtering, JCGT
  ///           10(2), 2021, but with the variance 1 / 12 of a box pixel in place of a Gaussian's 1 / 2π.
  void (*compute_normal_variance)(const FragmentBatch& batch, const TriangleVertices& vertices,
                                  const InstanceTransform* transforms, ShadingState& state);
  /// roughness = (α² + variance)^¼ with α = roughness², at most 1.
  void (*widen_roughness)(ShadingState& state);
  /// Turns normals by the gradient of a height, in world space: n - facing × (gradient - n (n · gradient)), normalised.
  /// Source    Blinn, Simulation of Wrinkled Surfaces, SIGGRAPH 1978; Mikkelsen, Bump Mapping Unparametrized Surfaces on
  ///           the GPU, 2010.
  void (*tilt_normals)(const FragmentBatch& batch, const float* const gradient[3], ShadingState& state);
  /// Fragments without a normal get the direction to the viewer.
  void (*default_normals)(const Viewpoint& viewpoint, const FragmentBatch& batch, ShadingState& state);

  // From the material to the colour: clamped to [0, 1e9], and so always finite; × alpha where the material is blended.
  /// base (ambient × occlusion + diffuse) + specular colour × specular + emissive; an environment map adds occlusion ×
  /// its light to diffuse and specular.
  void (*light_phong)(const ShadingUniforms& uniforms, const FragmentBatch& batch, const ShadingState& state,
                      FragmentOutputs& out);
  /// The lights' metallic-roughness reflections + occlusion × that of the environment + emissive.
  void (*light_metallic)(const ShadingUniforms& uniforms, const FragmentBatch& batch, const ShadingState& state,
                         FragmentOutputs& out);
  /// The same with an environment map.
  void (*light_metallic_in_map)(const ShadingUniforms& uniforms, const FragmentBatch& batch, const ShadingState& state,
                                FragmentOutputs& out);
  /// The same for a surface with layers. Before a background that is not the environment, transmissive surfaces are
  /// transparent where nothing of the scene is behind them: their alpha is 1 - the part of light that passes, of the
  /// colour of which least passes, but at least their brightest channel. The rest of the light that passes is that of
  /// the background's colour, or, before a transparent background, of the environment.
  void (*light_layered)(const ShadingUniforms& uniforms, const LayeredUniforms& layers, const FragmentBatch& batch,
                        const ShadingState& state, const LayerState& layer_state, FragmentOutputs& out);
  /// Replaces colours that one of the stages above has computed by one of their components, with the same alpha. The
  /// specular component is the colour without the others. `layers` is null after light_phong and light_metallic.
  void (*keep_component)(LightComponent component, const ShadingUniforms& uniforms, const LayeredUniforms* layers,
                         const FragmentBatch& batch, const ShadingState& state, const LayerState& layer_state,
                         FragmentOutputs& out);
  void (*unlit)(bool is_blended, const ShadingState& state, FragmentOutputs& out);
};

}  // namespace zoneplate
