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

  /// The level of a roughness: levels × r (1.5 - 0.5 r), denser where lobes are narrow.
  template <class F>
  [[gnu::always_inline]] F level(F roughness) const {
    return F(static_cast<float>(levels - 1)) * roughness * (F(1.5f) - F(0.5f) * roughness);
  }
};

}  // namespace zoneplate
