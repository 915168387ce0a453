// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/shade/environment/cube.h"

namespace zoneplate {

/// The light of one texel of a cube map: sums over directions within it.
struct TexelLight {
  float3 light{0, 0, 0};                      ///< of radiance × weight
  float weight = 0, x = 0, y = 0;             ///< of the weights, and of the weights × the place
  float power = 0, power_x = 0, power_y = 0;  ///< the same weighted by the sum of the radiance's channels

  /// `weight_of_direction` is proportional to the solid angle that a direction stands for; its place is counted from
  /// the centre, in texels.
  void add(float3 radiance, float weight_of_direction, float place_x, float place_y) {
    const float3 weighted = radiance * weight_of_direction;
    const float of_power = weighted.x + weighted.y + weighted.z;
    light = light + weighted;
    weight += weight_of_direction, x += weight_of_direction * place_x, y += weight_of_direction * place_y;
    power += of_power, power_x += of_power * place_x, power_y += of_power * place_y;
  }
};

/// The control points of a spline that has the light of these texels, in the order of CubeImage: every texel's light
/// at its centroid, shared by the four texels about that. So a lamp that is smaller than a texel keeps its power and
/// its place. Light that is even within each texel is not moved.
///
/// Source    cloud in cell: Birdsall and Fuss, Clouds-in-Clouds, Clouds-in-Cells Physics for Many-Body Plasma
///           Simulation, Journal of Computational Physics 3, 1969.
/// Requires  every texel has a weight.
CubeImage cube_of_texels(int side, const std::vector<TexelLight>& texels);

}  // namespace zoneplate
