// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zoneplate {

/// A prepared environment in the form that kernels read: plain data, valid as long as its PreparedEnvironment.
///
/// Shape     cube maps (shade/environment/cube.h) of rising roughness, three floats a texel. The texels are the control
///           points of a spline, quadratic along both axes of a face and along the levels. A face has a border of one
///           texel, which continues it beyond its edges. The spline at level 0 is the radiance itself, at the last
///           level the radiance filtered by the lobe of roughness 1. One more map after the last level has the mean
///           of the radiance weighted by the cosine, irradiance / π, and is a spline of its own.
/// Range     finite; the spline is at least 0 but for its error.
struct EnvironmentView {
  static constexpr int max_levels = 28, faces = 6;
  const float* texels = nullptr;             ///< null: no environment; one float after the last texel is readable
  std::int32_t levels = 0;                   ///< at least 4
  std::int32_t side[max_levels + 1] = {};    ///< of a face, without its border
  std::int32_t offset[max_levels + 1] = {};  ///< where each level begins, in texels
  /// `side` of a level if the levels before and after it have as many texels and follow each other in memory, else 0.
  std::int32_t common_side[max_levels + 1] = {};
  float sharpness = 0;             ///< 1 / α² where the spacing of the levels in α² turns from even to geometric
  float levels_per_octave = 0;     ///< there
  float image_from_world[9] = {};  ///< a rotation, by rows
  float tint[3] = {1, 1, 1};       ///< multiplies the radiance

  /// The level of a roughness in [0, 1], from 0 to levels - 1.
  template <class F>
  [[gnu::always_inline]] F level(F roughness) const {
    const F alpha = roughness * roughness;
    return log2(F(1.0f) + alpha * alpha * F(sharpness)) * F(levels_per_octave);
  }
};

/// Three levels of an EnvironmentView, mixed for one roughness: a cube map whose look-ups read nine texels instead of
/// 27, with the same bits (shade/environment/level_mix.h).
struct MixedLevel {
  const float* texels = nullptr;  ///< as those of a level; null: not mixed
  std::int32_t side = 0;          ///< of a face, without its border
};

}  // namespace zoneplate
