// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Two unit vectors that are perpendicular to a unit axis and to each other.
/// Source    Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017.
struct Basis {
  float3 first, second;

  explicit Basis(float3 axis) {
    const float sign = axis.z < 0 ? -1.0f : 1.0f;
    const float a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
    first = {1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
    second = {b, sign + axis.y * axis.y * a, -axis.y};
  }
};

}  // namespace zoneplate
