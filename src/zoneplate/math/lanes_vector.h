// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate {

/// A three-component vector of a stage's lane type (math/lanes.h). Sums are in the order x, y, z.
template <class F>
struct Vector {
  F x, y, z;

  /// Loads the vectors of fragments i and following from three arrays.
  template <class Array>
  [[gnu::always_inline]] static Vector load(const Array& a, int i) {
    return {F::load(a[0] + i), F::load(a[1] + i), F::load(a[2] + i)};
  }
  template <class Array>
  [[gnu::always_inline]] void store(Array& a, int i) const {
    x.store(a[0] + i), y.store(a[1] + i), z.store(a[2] + i);
  }
  /// The same vector in every lane.
  template <class T>
  [[gnu::always_inline]] static Vector all(const T (&a)[3]) {
    return {F(a[0]), F(a[1]), F(a[2])};
  }

  [[gnu::always_inline]] friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  [[gnu::always_inline]] friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  [[gnu::always_inline]] friend Vector operator*(Vector a, Vector b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  [[gnu::always_inline]] friend Vector operator*(Vector a, F s) { return {a.x * s, a.y * s, a.z * s}; }
  [[gnu::always_inline]] friend F dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  [[gnu::always_inline]] friend Vector cross(Vector a, Vector b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  [[gnu::always_inline]] friend Vector select(typename F::Bool m, Vector a, Vector b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
  }
  /// a / |a|; zero if |a| is below 1e-18 or above 1e19. Requires finite a.
  [[gnu::always_inline]] friend Vector normalize(Vector a) {
    const F square = dot(a, a);
    return a * select(square > F(1e-36f), F(1.0f) / sqrt(square), F(0.0f));
  }
};

}  // namespace zoneplate
