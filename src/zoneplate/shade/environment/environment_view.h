// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace zoneplate {

/// A prepared environment in the form that kernels read: plain data, valid as long as its PreparedEnvironment.
///
/// Shape     cube maps (shade/environment/cube.h) of rising roughness, four floats a texel, of which three are the
///           radiance filtered by the lobe of the level's roughness. A face has a border of one texel, which continues
///           it on its neighbours. Level 0 is not filtered; the last level has roughness 1: the mean of the radiance
///           weighted by the cosine, irradiance / π.
/// Range     finite, at least 0.
struct EnvironmentView {
  static constexpr int max_levels = 16;
  const float* texels = nullptr;         ///< null: no environment
  std::int32_t levels = 0;               ///< at least 2
  std::int32_t side[max_levels] = {};    ///< of a face, without its border
  std::int32_t offset[max_levels] = {};  ///< where each level begins, in texels
  float image_from_world[9] = {};        ///< a rotation, by rows
  float tint[3] = {1, 1, 1};             ///< multiplies the radiance

  /// The roughness of level 1; that of the others rises by equal factors to 1.
  static constexpr float first_roughness = 0.075f;
  static constexpr float octaves = 3.736966f;  ///< log2(1 / first_roughness)

  /// The level of a roughness in [0, 1], with the fraction towards the next one.
  template <class F>
  [[gnu::always_inline]] F level(F roughness) const {
    const F above =
        (log2(max(roughness, F(first_roughness))) + F(octaves)) * F(static_cast<float>(levels - 2) / octaves);
    return min(min(roughness * F(1 / first_roughness), F(1.0f)) + max(above, F(0.0f)),
               F(static_cast<float>(levels - 1)));
  }
};

}  // namespace zoneplate
