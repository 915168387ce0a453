// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/bordered_cube.h"

#include <algorithm>

namespace zoneplate {
namespace {

/// Between the four nearest texels of the face that a direction meets.
float3 bilinear(const CubeImage& cube, float3 direction) {
  const cube::Place place = cube::place(direction);
  const auto last = static_cast<float>(cube.side - 1);
  const auto texel = [&](float c) {
    return std::clamp((c + 1) * 0.5f * static_cast<float>(cube.side) - 0.5f, 0.0f, last);
  };
  const float x = texel(place.s), y = texel(place.t);
  const int column = std::min(static_cast<int>(x), cube.side - 2), row = std::min(static_cast<int>(y), cube.side - 2);
  const float right = x - static_cast<float>(column), down = y - static_cast<float>(row);
  const auto in_row = [&](int r) {
    const float3 a = cube.texels[cube.index(place.face, column, r)];
    return a + (cube.texels[cube.index(place.face, column + 1, r)] - a) * right;
  };
  const float3 above = in_row(row);
  return above + (in_row(row + 1) - above) * down;
}

}  // namespace

BorderedCube with_border(const CubeImage& cube) {
  BorderedCube out(cube.side, 1);
  for (int face = 0; face < cube::faces; ++face)
    for (int y = -1; y <= cube.side; ++y)
      for (int x = -1; x <= cube.side; ++x) {
        const bool is_inside = x >= 0 && y >= 0 && x < cube.side && y < cube.side;
        out.at(face, x, y) =
            is_inside ? cube.texels[cube.index(face, x, y)]
                      : bilinear(cube, cube::point(face, cube::centre(x, cube.side), cube::centre(y, cube.side)));
      }
  return out;
}

}  // namespace zoneplate
