// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/texel_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "zoneplate/shade/environment/cube.h"

namespace zoneplate {
namespace {

/// The texel (x, y) of a face, or the one of a neighbouring face where it lies beyond an edge.
std::size_t texel_at(const CubeImage& cube, int face, int x, int y) {
  if (x >= 0 && y >= 0 && x < cube.side && y < cube.side) return cube.index(face, x, y);
  const cube::Place place = cube::place(cube::point(face, cube::centre(x, cube.side), cube::centre(y, cube.side)));
  const auto texel = [&](float c) {
    return std::clamp(static_cast<int>((c + 1) * 0.5f * static_cast<float>(cube.side)), 0, cube.side - 1);
  };
  return cube.index(place.face, texel(place.s), texel(place.t));
}

/// The cube of the inverse distance of a texel from the centre: the solid angle over the area.
float density(const CubeImage& cube, int face, int x, int y) {
  const float3 p = cube::point(face, cube::centre(x, cube.side), cube::centre(y, cube.side));
  const float square = dot(p, p);
  return 1 / (square * std::sqrt(square));
}

}  // namespace

CubeImage cube_of_texels(int side, std::vector<TexelLight> texels) {
  CubeImage cube{side, std::vector<float3>(texels.size()), {}};
  const auto offset = [&](float power_sum, float power, float sum, float weight) {
    return std::clamp(power_sum / power - sum / weight, -0.5f, 0.5f);
  };
  for (int face = 0; face < cube::faces; ++face)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const TexelLight& from = texels[cube.index(face, x, y)];
        const TexelLight::Sums &power = from.power, &weights = from.weights;
        if (!(power.one > 0)) continue;
        const float3 light = from.light * (density(cube, face, x, y) / weights.one);
        const float right = offset(power.x, power.one, weights.x, weights.one),
                    down = offset(power.y, power.one, weights.y, weights.one);
        const float across[2] = {1 - std::abs(right), std::abs(right)}, along[2] = {1 - std::abs(down), std::abs(down)};
        const int step_x = right < 0 ? -1 : 1, step_y = down < 0 ? -1 : 1;
        for (int k = 0; k < 4; ++k) {
          float3& to = cube.texels[texel_at(cube, face, x + k % 2 * step_x, y + k / 2 * step_y)];
          to = to + light * (across[k % 2] * along[k / 2]);
        }
      }
  for (int face = 0; face < cube::faces; ++face)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        float3& texel = cube.texels[cube.index(face, x, y)];
        texel = texel * (1 / density(cube, face, x, y));
      }
  cube.source = std::move(texels);
  return cube;
}

}  // namespace zoneplate
