// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "zoneplate/image/plane.h"
#include "zoneplate/scene/light.h"
#include "zoneplate/shade/shadow/light_visibility.h"
#include "zoneplate/shade/shadow/shadows.h"

namespace zoneplate {

/// The surfaces nearest to a light, as an image from its position.
struct ShadowMap {
  float3 eye, right, up, forward;  ///< the light's camera: a position and unit axes
  bool is_perspective = false;
  float scale = 1;     ///< texels per unit: of length, or (perspective) of length at the distance 1
  float farthest = 1;  ///< greatest distance of any surface
  Plane<float> depth;  ///< distances along `forward` at the texels' centres; infinite where there is nothing
};

/// The four moments of warped depths that EVSM filters: e, e² of the positive and of the negative warp.
using WarpedMoments = std::array<float, 4>;

/// Visibility by shadow maps.
///
/// A receiver is compared with each texel at the depth that its own plane has at the texel's centre, so that a plane
/// does not shadow itself under any filter.
/// Source    shadow maps: Williams, Casting Curved Shadows on Curved Surfaces, SIGGRAPH 1978; PCF: Reeves, Salesin and
///           Cook, Rendering Antialiased Shadows with Depth Maps, SIGGRAPH 1987; PCSS: Fernando, Percentage-Closer Soft
///           Shadows, SIGGRAPH 2005 sketches; the plane of the receiver: Isidoro, Shadow Mapping, GDC 2006; EVSM:
///           Lauritzen and McCool, Layered Variance Shadow Maps, GI 2008.
class MappedVisibility : public LightVisibility {
 public:
  /// The maps of light k are maps[k]: one, or the six sides of a cube. `environment` may be null: no occlusion.
  MappedVisibility(std::vector<Light> lights, std::vector<std::vector<ShadowMap>> maps, const ShadowOptions& options,
                   const LightVisibility* environment);

  void of_light(int k, const Receivers& receivers, float* visible) const override;
  bool has_occlusion() const override { return environment_ != nullptr && environment_->has_occlusion(); }
  void of_environment(const Receivers& receivers, float* visible) const override {
    environment_->of_environment(receivers, visible);
  }

 private:
  struct Texels;  ///< a receiver in a map
  float at(const Light& light, const ShadowMap& map, const Plane<WarpedMoments>* moments, const Texels& receiver,
           std::uint32_t seed) const;

  std::vector<Light> lights_;
  std::vector<std::vector<ShadowMap>> maps_;                ///< by light
  std::vector<std::vector<Plane<WarpedMoments>>> moments_;  ///< the same, for ShadowFilter::Evsm
  ShadowOptions options_;
  const LightVisibility* environment_;
};

}  // namespace zoneplate
