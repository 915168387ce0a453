// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "zoneplate/raster/geometry/draw.h"
#include "zoneplate/raster/types/fragment_shader.h"
#include "zoneplate/scene/camera.h"
#include "zoneplate/shade/surface/lighting.h"
#include "zoneplate/shade/surface/surface.h"

namespace zoneplate {

/// A square under a scene: a little below its lowest point along Scene::up, several times as wide as the scene.
struct GroundSquare {
  float3 up;
  std::array<float3, 4> corner;  ///< counter-clockwise as seen from above
  float margin = 0;              ///< Receivers::margin

  explicit GroundSquare(const Scene& scene);
  /// The same camera with near and far planes that enclose what it sees of the square.
  Camera enclosing(Camera camera) const;
};

/// The square under the scene as a surface that is visible only where light is missing on it: black, with the alpha 1 -
/// the part of its illuminance that arrives.
///
/// It faces upwards and is drawn last, as a blended surface: data passes do not contain it.
class Ground {
 public:
  /// `view` has a visibility, which outlives this object.
  Ground(const Scene& scene, const ViewUniforms& view);

  /// The draw, which refers to this object. Requires: no other draw has this instance or material.
  Draw draw(const float4x4& clip_from_world, std::uint32_t instance, int material) const;
  void shade(const FragmentBatch& batch, FragmentOutputs& out) const;
  bool needs_derivatives() const;

 private:
  const LightVisibility& visibility_;
  std::vector<PreparedLight> lights_;
  float environment_;  ///< luminance
  float reflectance_ = 0.318309886f;
  GroundSquare square_;
};

}  // namespace zoneplate
