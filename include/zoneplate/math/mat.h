// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "zoneplate/math/vec.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// A 4 × 4 matrix that acts on column vectors; stored by columns, as glTF does.
///
/// Transforms are named target_from_source: `clip_from_world * world_from_object`.
struct float4x4 {
  /// The images of the x, y and z axes, and the translation. The default is the identity.
  std::array<float4, 4> column{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  bool operator==(const float4x4&) const = default;
};

/// The sum is taken in the order x, y, z, w: ((c0 x + c1 y) + c2 z) + c3 w.
constexpr float4 operator*(const float4x4& m, float4 v) {
  return m.column[0] * v.x + m.column[1] * v.y + m.column[2] * v.z + m.column[3] * v.w;
}

/// The transform that applies `b` first and then `a`.
constexpr float4x4 operator*(const float4x4& a, const float4x4& b) {
  return {{a * b.column[0], a * b.column[1], a * b.column[2], a * b.column[3]}};
}

/// A point (w = 1) under an affine transform. There is no division by w.
constexpr float3 transform_point(const float4x4& m, float3 p) { return xyz(m * float4{p.x, p.y, p.z, 1}); }
/// A direction (w = 0), which translations leave unchanged. Normals take `normal_matrix`.
constexpr float3 transform_vector(const float4x4& m, float3 v) { return xyz(m * float4{v.x, v.y, v.z, 0}); }

/// Determinant of the upper left 3 × 3 part: negative where the transform mirrors.
constexpr float determinant3(const float4x4& m) {
  return dot(xyz(m.column[0]), cross(xyz(m.column[1]), xyz(m.column[2])));
}

/// The matrix whose columns are the rows of `m`.
constexpr float4x4 transpose(const float4x4& m) {
  const auto& c = m.column;
  return {{float4{c[0].x, c[1].x, c[2].x, c[3].x}, float4{c[0].y, c[1].y, c[2].y, c[3].y},
           float4{c[0].z, c[1].z, c[2].z, c[3].z}, float4{c[0].w, c[1].w, c[2].w, c[3].w}}};
}

/// The matrix that carries normals: the cofactors of the 3 × 3 part (its inverse transpose times its determinant).
///
/// Exists for singular matrices too (a flattened object still has normals). Not normalised; where the
/// transform mirrors, the normals of the mirrored surface point to the side that is front after mirroring.
constexpr float4x4 normal_matrix(const float4x4& m) {
  const float3 a = xyz(m.column[0]), b = xyz(m.column[1]), c = xyz(m.column[2]);
  const float s = determinant3(m) < 0 ? -1.0f : 1.0f;
  const float3 x = cross(b, c) * s, y = cross(c, a) * s, z = cross(a, b) * s;
  return {{float4{x.x, x.y, x.z, 0}, float4{y.x, y.y, y.z, 0}, float4{z.x, z.y, z.z, 0}, float4{0, 0, 0, 1}}};
}

/// The inverse, computed in double precision; the identity where m is singular.
float4x4 inverse(const float4x4& m);

}  // namespace zoneplate
#pragma GCC visibility pop
