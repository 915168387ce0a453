// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "zoneplate/shade/environment/cube.h"

namespace zoneplate {

/// A cube map whose faces have a border, which continues them beyond their edges.
struct BorderedCube {
  int side = 0;    ///< of a face, without its border
  int border = 0;  ///< texels
  std::vector<float3> texels;

  BorderedCube() = default;
  BorderedCube(int face_side, int width)
      : side(face_side), border(width), texels(static_cast<std::size_t>(cube::faces * (pitch() * pitch()))) {}

  int pitch() const { return side + 2 * border; }
  /// Texel (x, y) of a face, from -border to side + border - 1.
  std::size_t index(int face, int x, int y) const {
    return static_cast<std::size_t>((face * pitch() + y + border) * pitch() + x + border);
  }
  const float3& at(int face, int x, int y) const { return texels[index(face, x, y)]; }
  float3& at(int face, int x, int y) { return texels[index(face, x, y)]; }
};

/// With a border of one texel, interpolated between the texels of the neighbouring face.
BorderedCube with_border(const CubeImage& cube);

}  // namespace zoneplate
