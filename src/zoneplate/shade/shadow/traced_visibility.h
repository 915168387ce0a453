// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "zoneplate/ray/trace.h"
#include "zoneplate/scene/light.h"
#include "zoneplate/shade/environment/environment_view.h"
#include "zoneplate/shade/shadow/adaptive_disc.h"
#include "zoneplate/shade/shadow/disc_samples.h"
#include "zoneplate/shade/shadow/environment_rays.h"
#include "zoneplate/shade/shadow/light_visibility.h"
#include "zoneplate/shade/shadow/shadows.h"

namespace zoneplate {

/// Visibility by rays.
///
/// A light with an extent is a sphere (point, spot) or a distant disc (directional), seen from the receiver as a cone
/// of directions; its part that is visible is the mean over rays of a uniform density in solid angle. The first quarter
/// of all rays to a light, also where fewer are traced, decides alone where none or all of them are blocked. The
/// rays begin all over the part of the pixel that the triangle covers, which filters the edge of a shadow that is
/// sharper than a pixel.
/// Exact     the same bits for any number of threads and any instruction set: the rays depend on the receiver's position
///           in the image, the light and the options only.
class TracedVisibility : public LightVisibility {
 public:
  /// `lights` in world space. `environment` weights what is occluded by its light; null: all directions count alike.
  ///
  /// Requires  the tree and the context of `opacity` outlive this object; `occlusion.distance` > 0
  ///           where there are samples.
  TracedVisibility(const Bvh& bvh, const OpacityOfHits& opacity, std::vector<Light> lights,
                   const ShadowOptions& shadows, const OcclusionOptions& occlusion,
                   const EnvironmentView* environment = nullptr);

  void of_light(int k, const Receivers& receivers, float* visible) const override;
  /// Whether light k is above the horizon of receiver i.
  bool is_lit(int k, const Receivers& receivers, int i) const;
  bool needs_footprint() const override { return shadows_.method == ShadowMethod::Soft; }
  bool has_occlusion() const override { return occlusion_.samples > 0; }
  void of_environment(const Receivers& receivers, float* visible) const override;

 private:
  /// A light as a receiver sees it.
  struct SeenLight {
    float3 direction;  ///< unit, to its centre
    float distance = std::numeric_limits<float>::infinity();
    float height = 0;  ///< 1 - the cosine of its angular radius
  };
  SeenLight see(std::size_t k, float3 from) const;
  template <class MakeRay>
  void compute_means(const Receivers& receivers, std::span<const int> which, const MakeRay& ray, float* visible) const;
  float of_uniform_light(const Receivers& receivers, int i, float3 origin, const BvhTop& top) const;
  float of_rays(EnvironmentRays::Hemisphere& light, const Receivers& receivers, int i, float3 origin,
                const BvhTop& top) const;

  BvhView bvh_;
  Box bounds_;  ///< of all casters
  OpacityOfHits opacity_;
  std::vector<Light> lights_;
  std::vector<SeenLight> seen_;  ///< by light: that of a directional one, which is the same from everywhere
  float sine_of_angle_;          ///< of a light without a radius
  ShadowOptions shadows_;
  OcclusionOptions occlusion_;
  std::optional<EnvironmentRays> environment_;  ///< none: light from all sides alike
  DiscLattice lattice_;                         ///< of rays to lights
  std::vector<AdaptiveDisc> hemispheres_;       ///< of rays to light from all sides, by halvings of their number
  const RayKernels& kernels_;
};

}  // namespace zoneplate
