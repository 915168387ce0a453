// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "zoneplate/math/vec.h"
#include "zoneplate/shade/environment/texel_light.h"

namespace zoneplate {

/// The geometry of a cube map: face 2 a is that of the direction +a, face 2 a + 1 that of -a, for the axes a = x, y, z.
/// On a face of the axis a, s and t in [-1, 1] are the coordinates along the axes a + 1 and a + 2 (cyclic) where the
/// coordinate along a is ±1.
namespace cube {

inline constexpr int faces = 6;

/// The vector from the centre of the cube to the point (s, t) of a face; s and t may lie beyond [-1, 1].
inline float3 point(int face, float s, float t) {
  const float one = face % 2 == 0 ? 1.0f : -1.0f;
  if (face < 2) return {one, s, t};
  if (face < 4) return {t, one, s};
  return {s, t, one};
}

/// The coordinates of a vector along s and t of a face.
inline float2 across(int face, float3 v) {
  if (face < 2) return {v.y, v.z};
  if (face < 4) return {v.z, v.x};
  return {v.x, v.y};
}

/// The coordinate of the centre of texel i of a row of `side`; i may lie beyond the row.
inline float centre(int i, int side) { return (2 * static_cast<float>(i) + 1) / static_cast<float>(side) - 1; }

/// The face that a direction meets, and where.
struct Place {
  int face;
  float s, t;
};

/// Requires  d is not zero.
inline Place place(float3 d) {
  const float ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
  if (ax >= ay && ax >= az) return {d.x < 0 ? 1 : 0, d.y / ax, d.z / ax};
  if (ay >= az) return {d.y < 0 ? 3 : 2, d.z / ay, d.x / ay};
  return {d.z < 0 ? 5 : 4, d.x / az, d.y / az};
}

}  // namespace cube

/// Radiance from all directions, as a cube map: `side` × `side` texels a face, rows along s, one face after the other.
struct CubeImage {
  int side = 0;
  std::vector<float3> texels;
  /// The light of each texel as it was before it became control points of a spline. Empty: the spline is the light.
  std::vector<TexelLight> source;

  std::size_t index(int face, int x, int y) const {
    return (static_cast<std::size_t>(face) * static_cast<std::size_t>(side) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(side) +
           static_cast<std::size_t>(x);
  }
};

}  // namespace zoneplate
