#pragma once

#include <memory>

#include "zoneplate/base/isa.h"
#include "zoneplate/raster/batch.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

class TextureSet;

/// What the whole picture has in common for shading.
struct Surroundings {
  float3 eye{0, 0, 0};              ///< camera position, world space
  float3 view_direction{0, 0, -1};  ///< the way an orthographic camera looks
  bool is_orthographic = false;
  float3 environment{0, 0, 0};    ///< radiance of a constant environment, from all sides
  float3 ambient_light{0, 0, 0};  ///< (Blinn-)Phong's ambient term
  bool raw_colors = false;        ///< images are taken as they are, not decoded from sRGB (--color-management raw)
  Isa isa = best_isa();           ///< every one gives the same bits
};

/// Shades a scene's surfaces with its materials and lights, in batched stages.
///
/// Textures are decoded and their levels made when it is built (in parallel), unless they are given. It keeps
/// references to the scene. `shade` and `alpha` are const and may be called from any thread.
class SurfaceShader {
 public:
  /// `textures`: those of the scene, made before; null: made here.
  SurfaceShader(const Scene& scene, const Surroundings& surroundings, const TextureSet* textures = nullptr);
  ~SurfaceShader();
  SurfaceShader(const SurfaceShader&) = delete;
  SurfaceShader& operator=(const SurfaceShader&) = delete;

  struct Wanted {
    bool normal = false, uv = false, albedo = false;
  };

  /// Colours of a batch; opaque surfaces have a = 1, masked ones too.
  void shade(const Batch& batch, Wanted wanted, Shaded& out) const;

  /// Alpha of a batch (base colour factor, texture and vertex colour), the same bits as `shade` works with.
  void alpha(const Batch& batch, float* out) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace zoneplate
