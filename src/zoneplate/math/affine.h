// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "zoneplate/math/mat.h"

namespace zoneplate {

/// An affine transform in doubles, for places far from the origin: p becomes x p.x + y p.y + z p.z + move.
struct Affine {
  double3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< the images of the axes
  double3 move;                                ///< the image of the origin
  bool operator==(const Affine&) const = default;
};

/// A direction, which `move` leaves unchanged.
constexpr double3 transform_vector(const Affine& a, double3 v) {
  return {a.x.x * v.x + a.y.x * v.y + a.z.x * v.z, a.x.y * v.x + a.y.y * v.y + a.z.y * v.z,
          a.x.z * v.x + a.y.z * v.y + a.z.z * v.z};
}
constexpr double3 transform_point(const Affine& a, double3 p) { return transform_vector(a, p) + a.move; }

/// The transform that applies `b` first and then `a`.
constexpr Affine operator*(const Affine& a, const Affine& b) {
  return {transform_vector(a, b.x), transform_vector(a, b.y), transform_vector(a, b.z), transform_point(a, b.move)};
}

/// The same transform in doubles.
///
/// Requires  `m` is affine.
constexpr Affine widened(const float4x4& m) {
  return {widened(xyz(m.column[0])), widened(xyz(m.column[1])), widened(xyz(m.column[2])), widened(xyz(m.column[3]))};
}

/// The transform followed by a move by -origin, in floats. The move is subtracted before rounding.
constexpr float4x4 narrowed(const Affine& a, double3 origin) {
  const float3 x = narrowed(a.x), y = narrowed(a.y), z = narrowed(a.z), t = narrowed(a.move - origin);
  return {{float4{x.x, x.y, x.z, 0}, float4{y.x, y.y, y.z, 0}, float4{z.x, z.y, z.z, 0}, float4{t.x, t.y, t.z, 1}}};
}

/// A rotation by the quaternion x i + y j + z k + w, which is normalised first; zero gives the identity.
inline Affine rotation(double x, double y, double z, double w) {
  const double n = std::sqrt(x * x + y * y + z * z + w * w);
  if (!(n > 0)) return {};
  x /= n, y /= n, z /= n, w /= n;
  return {.x = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          .y = {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          .z = {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
          .move = {}};
}

}  // namespace zoneplate
