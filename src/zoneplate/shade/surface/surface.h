#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "zoneplate/raster/types/batch.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

class TextureSet;
class InterleavedVertices;

/// The way from a pixel to the viewer: first + x dx + y dy, of any length; x, y as in FragmentBatch.
struct PixelRays {
  float3 first, dx, dy;
};

/// What the whole picture has in common for shading.
struct ViewUniforms {
  float3 eye{0, 0, 0};              ///< camera position, world space
  float3 view_direction{0, 0, -1};  ///< the way an orthographic camera looks
  bool is_orthographic = false;
  std::optional<PixelRays> rays;  ///< of a perspective camera; without them they are made from positions
  std::vector<Light> lights;      ///< in world space
  float3 environment{0, 0, 0};    ///< radiance of a constant environment, from all sides
  float3 ambient_light{0, 0, 0};  ///< (Blinn-)Phong's ambient term
  bool raw_colors = false;        ///< images are taken as they are, not decoded from sRGB (--color-management raw)
  int anisotropy = 1;             ///< probes of a texture's footprint, for all samplers that blend levels
};

/// Shades a scene's surfaces with its materials and lights, in batched stages.
///
/// It keeps references to the scene, its textures and its vertices. `shade` and `alpha` are const and may be called
/// from any thread.
class SurfaceShader {
 public:
  /// `textures`, `records`: those of the scene. The lights are those of `surroundings`.
  SurfaceShader(const Scene& scene, const ViewUniforms& surroundings, const TextureSet& textures,
                const InterleavedVertices& records);
  ~SurfaceShader();
  SurfaceShader(const SurfaceShader&) = delete;
  SurfaceShader& operator=(const SurfaceShader&) = delete;

  /// Shades a batch. Opaque and alpha-tested surfaces have a = 1.
  void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const;

  /// Alpha of a batch (base colour factor, texture and vertex colour), the same bits as `shade` works with.
  void alpha(const FragmentBatch& batch, float* out) const;

  /// What no channel of any colour is above.
  float brightest() const { return brightest_; }

  /// Whether a material's batches need dbdx and dbdy.
  bool needs_derivatives(int material) const;

  /// What shading reads of an instance's first vertex; the other vertices follow.
  std::span<const float> vertex_record(std::uint32_t instance, int material) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
  float brightest_;
};

}  // namespace zoneplate
