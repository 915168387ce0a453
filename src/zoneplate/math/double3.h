// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/vec.h"

namespace zoneplate {

constexpr double3 operator*(double3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
/// The dot product, summed in the order x, y, z.
constexpr double dot(double3 a, double3 b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
constexpr double3 cross(double3 a, double3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// The point at part `t` of the way from a to b.
constexpr double3 mix(double3 a, double3 b, double t) { return a + (b - a) * t; }

}  // namespace zoneplate
