// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/light.h"

namespace zoneplate {

/// A light in the form that kernels read.
struct PreparedLight {
  bool is_directional = true, is_spot = false, is_quadratic = false;
  float radiance[3] = {0, 0, 0};  ///< colour × intensity
  float towards[3] = {0, 0, 1};   ///< directional: unit direction to the light
  float position[3] = {0, 0, 0};
  float axis[3] = {0, 0, -1};  ///< spot: unit direction in which it shines
  float inverse_range4 = 0;    ///< 1 / range⁴; 0: unlimited range
  float attenuation[3] = {1, 0, 0};
  float spread = 0;  ///< what its disc adds to α² of highlights; of a point or spot light, at a distance of 1
  float cone_scale = 0, cone_offset = 1;  ///< glTF's lightAngleScale and lightAngleOffset
};

PreparedLight prepare(const Light& light);

/// Distances below 1 mm count as 1 mm, which keeps 1 / d² finite.
inline constexpr float min_distance_squared = 1e-6f;

/// The attenuation of a point light at a squared distance.
///
/// Inverse square: max(min(1 - (d / range)⁴, 1), 0) / d². Quadratic: 1 / (a0 + a1 d + a2 d²).
/// Edges     d² below `min_distance_squared` counts as that value; a quadratic below 1e-6 counts as 1e-6.
/// Source    KHR_lights_punctual, "Range Property"; the fixed-function attenuation of OpenGL 1.x.
template <class F>
[[gnu::always_inline]] inline F fading(const PreparedLight& light, F distance_squared) {
  const F d2 = max(distance_squared, F(min_distance_squared));
  if (light.is_quadratic) {
    const F quadratic = F(light.attenuation[0]) + F(light.attenuation[1]) * sqrt(d2) + F(light.attenuation[2]) * d2;
    return F(1.0f) / max(quadratic, F(1e-6f));
  }
  const F window = F(1.0f) - d2 * d2 * F(light.inverse_range4);
  return max(window, F(0.0f)) / d2;
}

/// The angular attenuation of a spot light, by the cosine of the angle to its axis: clamp(cosine × scale + offset, 0,
/// 1)².
/// Source: KHR_lights_punctual, "Inner and Outer Cone Angles".
template <class F>
[[gnu::always_inline]] inline F cone(const PreparedLight& light, F cosine) {
  const F cone_weight = min(max(cosine * F(light.cone_scale) + F(light.cone_offset), F(0.0f)), F(1.0f));
  return cone_weight * cone_weight;
}

}  // namespace zoneplate
