// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/math/vec.h"

namespace zoneplate {

struct CubeImage;

/// The light of one texel of a cube map: sums over directions within it.
struct TexelLight {
  /// Of weights, times the products of up to two coordinates of the place.
  struct Sums {
    float one = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    void add(float weight, float place_x, float place_y) {
      const float weighted_x = weight * place_x, weighted_y = weight * place_y;
      one += weight, x += weighted_x, y += weighted_y;
      xx += weighted_x * place_x, xy += weighted_x * place_y, yy += weighted_y * place_y;
    }
  };
  float3 light{0, 0, 0}, light_x{0, 0, 0}, light_y{0, 0, 0};  ///< of radiance × weight, and times the place
  Sums weights, power;                                        ///< `power`: weighted by the sum of the channels

  /// `weight` is proportional to the solid angle that a direction stands for; its place is counted from the centre, in
  /// texels.
  void add(float3 radiance, float weight, float place_x, float place_y) {
    const float3 weighted = radiance * weight;
    light = light + weighted, light_x = light_x + weighted * place_x, light_y = light_y + weighted * place_y;
    weights.add(weight, place_x, place_y);
    power.add(weighted.x + weighted.y + weighted.z, place_x, place_y);
  }
};

/// The control points of a spline that has the light of these texels, in the order of CubeImage: every texel's light
/// at its centroid, shared by the four texels about that. So a lamp that is smaller than a texel keeps its power and
/// its place. Light that is even within each texel is not moved. The texels become the source of the result.
///
/// Source    cloud in cell: Birdsall and Fuss, Clouds-in-Clouds, Clouds-in-Cells Physics for Many-Body Plasma
///           Simulation, Journal of Computational Physics 3, 1969.
/// Requires  every texel has a weight.
CubeImage cube_of_texels(int side, std::vector<TexelLight> texels);

}  // namespace zoneplate
