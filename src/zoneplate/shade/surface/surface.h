// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "zoneplate/raster/types/batch.h"
#include "zoneplate/raster/types/sampling.h"
#include "zoneplate/scene/scene.h"
#include "zoneplate/scene/texture_filter.h"
#include "zoneplate/shade/backdrop/backdrop_view.h"
#include "zoneplate/shade/environment/environment_view.h"

namespace zoneplate {

class TextureSet;
class InterleavedVertices;
class LightVisibility;
struct SurfaceConstants;

/// The vector from pixel (x, y) to the viewer: first + x dx + y dy, of any length; x, y as in FragmentBatch.
struct PixelRays {
  float3 first, dx, dy;
};

/// The shading inputs that are the same for the whole image.
struct ViewUniforms {
  float3 eye{0, 0, 0};              ///< camera position, world space
  float3 view_direction{0, 0, -1};  ///< of an orthographic camera
  bool is_orthographic = false;
  std::optional<PixelRays>
      rays;  ///< of a perspective camera; without rays, the vectors to the viewer follow from positions
  std::vector<Light> lights;             ///< in world space
  float3 environment{0, 0, 0};           ///< radiance of a constant environment; of a map, the greatest in each channel
  std::optional<EnvironmentView> map;    ///< none: the environment is constant
  std::optional<BackdropView> backdrop;  ///< what transmissive surfaces refract; none: the environment alone
  bool has_environment_behind = true;    ///< the background is the environment
  std::optional<float3> background;      ///< the radiance of a background of one colour
  float3 ambient_light{0, 0, 0};         ///< (Blinn-)Phong's ambient term
  /// Of lit surfaces; at Triangle and Vertex, fragments still look up the texture of the base colour.
  /// Requires  at Triangle and Vertex: no rays.
  ShadingFrequency shading_frequency = ShadingFrequency::Fragment;
  bool raw_colors = false;  ///< the values of images are linear, not decoded from sRGB (--color-management raw)
  LightComponent component = LightComponent::All;  ///< of each surface's colour
  const LightVisibility* visibility = nullptr;     ///< of `lights`, in their order; null: nothing casts shadows
  TextureFilter texture_filter;                    ///< of all textures; by default that of each sampler
  SpecularAntialiasing specular_aa = SpecularAntialiasing::None;
  int anisotropy = 1;  ///< maximum number of probes along a footprint, for all samplers that blend mip levels
};

/// Shades a scene's surfaces with its materials and lights, in batched stages.
///
/// The shader keeps references to the scene, its textures and its vertices. `shade` and `alpha` are const and may be
/// called from any thread.
class SurfaceShader {
 public:
  /// `textures` and `records` belong to the scene. The lights are those of `view`.
  SurfaceShader(const Scene& scene, const ViewUniforms& view, const TextureSet& textures,
                const InterleavedVertices& records);
  ~SurfaceShader();
  SurfaceShader(const SurfaceShader&) = delete;
  SurfaceShader& operator=(const SurfaceShader&) = delete;

  /// Shades a batch. Opaque and alpha-tested surfaces have a = 1, but transmissive ones may be transparent before a
  /// background that is not the environment.
  void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const;

  /// Alpha of a batch (base colour factor, texture and vertex colour), with the bits that `shade` uses.
  void alpha(const FragmentBatch& batch, float* out) const;

  /// An upper bound of every channel of every colour.
  float brightest() const { return brightest_; }

  /// Whether a material's batches need dbdx and dbdy.
  bool needs_derivatives(int material) const;
  /// Whether batches need their coverage.
  bool needs_coverage() const;

  /// The record of an instance's first vertex, which shading reads; those of the other vertices follow.
  std::span<const float> vertex_record(std::uint32_t instance, int material) const;

 private:
  void shade_fragments(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const;
  void shade_triangles(const FragmentBatch& batch, FragmentOutputs& out) const;

  std::unique_ptr<const SurfaceConstants> constants_;
  float brightest_;
};

}  // namespace zoneplate
