// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Points of the unit square: a lattice, shifted by a random vector, whose first 2^k points are a lattice too for every
/// k.
///
/// Exact     integer arithmetic only.
/// Source    extensible lattices: Hickernell, Hong, L'Ecuyer and Lemieux, SIAM J. Sci. Comput. 22, 2000. The generator
///           (1, 39) has the least error of occlusion by a sphere, over 16, 32, 64 and 256 points, of those tried.
class ShiftedLattice {
 public:
  /// `dimension`: which of the independent lattices of a receiver.
  ShiftedLattice(std::uint32_t seed, std::uint32_t dimension)
      : x_(hash(seed, dimension, 1)), y_(hash(seed, dimension, 2)) {}

  /// Point i, in [0, 1)².
  float2 operator()(std::uint32_t i) const {
    const std::uint32_t r = reversed(i);
    return {unit_float(r + x_), unit_float(r * 39u + y_)};
  }

 private:
  /// The bits in reverse order.
  static constexpr std::uint32_t reversed(std::uint32_t v) {
    v = (v >> 1 & 0x55555555u) | (v & 0x55555555u) << 1;
    v = (v >> 2 & 0x33333333u) | (v & 0x33333333u) << 2;
    v = (v >> 4 & 0x0f0f0f0fu) | (v & 0x0f0f0f0fu) << 4;
    v = (v >> 8 & 0x00ff00ffu) | (v & 0x00ff00ffu) << 8;
    return v >> 16 | v << 16;
  }

  std::uint32_t x_, y_;
};

/// Directions about a unit axis.
/// Source    the basis: Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017.
class DirectionsAbout {
 public:
  explicit DirectionsAbout(float3 axis) : axis_(axis) {
    const float sign = axis.z < 0 ? -1.0f : 1.0f;
    const float a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
    first_ = {1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
    second_ = {b, sign + axis.y * axis.y * a, -axis.y};
  }

  /// Uniform in solid angle over the cone of the directions whose cosine with the axis is at least 1 - height.
  float3 of_cone(float2 u, float height) const {
    const float below = u.x * height;
    return at(std::sqrt(below * (2 - below)), 1 - below, u.y);
  }
  /// Density proportional to the cosine with the axis.
  float3 of_cosine(float2 u) const { return at(std::sqrt(u.x), std::sqrt(1 - u.x), u.y); }

 private:
  float3 at(float sine, float cosine, float turn) const {
    const float angle = 6.28318531f * turn;
    return first_ * (sine * cos(angle)) + second_ * (sine * sin(angle)) + axis_ * cosine;
  }
  float3 axis_, first_, second_;
};

}  // namespace zoneplate
