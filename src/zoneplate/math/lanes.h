// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "zoneplate/math/elementary.h"

/// One number with the operations that kernels are written in.
///
/// A shading stage or another kernel is a template over such a type, in a file `*_lanes.h`: `Lane<float>` instantiates
/// the scalar version, math/lanes_simd.h the vectors, and `Lane<double>` the references of the tests. Every operation
/// is correctly rounded, except the elementary functions, which are those of math/elementary.h (for double: of the C
/// library).
///
/// Edges     min and max return their second argument if either is NaN, as on x86.
namespace zoneplate::scalar {

/// The elementary functions of a lane's number: for float those of math/elementary.h, for double those of the C
/// library.
namespace number {

using zoneplate::acos, zoneplate::asin, zoneplate::atan2, zoneplate::coarse_log2, zoneplate::cos, zoneplate::exp;
using zoneplate::exp2, zoneplate::log, zoneplate::log2, zoneplate::pow, zoneplate::sin;
inline double log2(double x) { return std::log2(x); }
inline double coarse_log2(double x) { return std::log2(x); }
inline double exp2(double x) { return std::exp2(x); }
inline double exp(double x) { return std::exp(x); }
inline double log(double x) { return std::log(x); }
inline double sin(double x) { return std::sin(x); }
inline double cos(double x) { return std::cos(x); }
inline double acos(double x) { return std::acos(x); }
inline double asin(double x) { return std::asin(x); }
inline double pow(double x, double y) { return std::pow(x, y); }
inline double atan2(double y, double x) { return std::atan2(y, x); }

}  // namespace number

struct Bool {
  bool v;
  friend Bool operator&(Bool a, Bool b) { return {a.v && b.v}; }
  friend Bool operator|(Bool a, Bool b) { return {a.v || b.v}; }
  friend bool all(Bool a) { return a.v; }
  friend bool none(Bool a) { return !a.v; }
  /// Bit i: lane i.
  friend unsigned bits_of(Bool a) { return a.v ? 1 : 0; }
};

struct Int {
  static constexpr int lanes = 1;
  std::int32_t v;
  Int() = default;
  Int(std::int32_t x) : v(x) {}
  static Int load(const std::int32_t* p) { return *p; }
  void store(std::int32_t* p) const { *p = v; }
  /// Conversion from and to unsigned integers of 8 or 16 bits. Requires: values in their range.
  template <class T>
  static Int load_from(const T* p) {
    return static_cast<std::int32_t>(*p);
  }
  template <class T>
  void store_as(T* p) const {
    *p = static_cast<T>(v);
  }
  template <class T>
  static void store_zeros(T* p) {
    *p = 0;
  }
  /// Interleaves four bytes per lane. Requires: each in [0, 255].
  static void store_pixels(Int r, Int g, Int b, Int a, std::uint8_t* p) {
    r.store_as(p), g.store_as(p + 1), b.store_as(p + 2), a.store_as(p + 3);
  }
  /// Stores values i and following of an interleaved list: groups of four lanes of this, followed by the same four
  /// lanes of `second`.
  void store_by_fours(Int second, std::int16_t* list, int i) const {
    const int first = i / 4 * 8 + i % 4;
    list[first] = static_cast<std::int16_t>(v), list[first + 4] = static_cast<std::int16_t>(second.v);
  }
  static Int gather(const std::int32_t* table, Int i) { return table[i.v]; }
  /// Looks up elements of a table of 16.
  static Int look_up(const std::int32_t* table, Int i) { return table[i.v]; }
  std::int32_t first() const { return v; }
  bool equals(Int other) const { return v == other.v; }
  bool is_uniform() const { return true; }
  friend Int operator+(Int a, Int b) { return a.v + b.v; }
  friend Int operator-(Int a, Int b) { return a.v - b.v; }
  friend Int operator*(Int a, Int b) { return a.v * b.v; }
  friend Bool operator<(Int a, Int b) { return {a.v < b.v}; }
  friend Bool operator==(Int a, Int b) { return {a.v == b.v}; }
  friend Bool operator>(Int a, Int b) { return {a.v > b.v}; }
  friend Int operator&(Int a, Int b) { return a.v & b.v; }
  friend Int operator|(Int a, Int b) { return a.v | b.v; }
  template <int bits>
  Int shifted_right() const {
    return v >> bits;
  }
  friend Int min(Int a, Int b) { return a.v < b.v ? a : b; }
  friend Int max(Int a, Int b) { return a.v > b.v ? a : b; }
  friend Int select(Bool m, Int a, Int b) { return m.v ? a : b; }
  /// The maximum of the differences of the lowest three bytes.
  friend Int color_difference(Int a, Int b) {
    const auto of = [&](int shift) { return std::abs((a.v >> shift & 255) - (b.v >> shift & 255)); };
    return std::max({of(0), of(8), of(16)});
  }
  /// a if m, else 0.
  friend Int where(Bool m, Int a) { return m.v ? a.v : 0; }
};

template <class T>
struct Lane {
  using Bool = scalar::Bool;
  using Int = scalar::Int;
  using Four = Lane;  ///< a part of the lanes, at most four
  static constexpr int lanes = 1;
  T v;
  Lane() = default;
  Lane(T x) : v(x) {}
  static Lane load(const T* p) { return *p; }
  void store(T* p) const { *p = v; }
  /// Four consecutive numbers per lane: number c of each is loaded to, or stored from, v[c].
  static void load_fours(const T* p, Lane (&v)[4]) {
    for (int c = 0; c < 4; ++c) v[c] = p[c];
  }
  static void store_fours(const Lane (&v)[4], T* p) {
    for (int c = 0; c < 4; ++c) p[c] = v[c].v;
  }
  static Lane gather(const T* table, Int i) { return table[i.v]; }
  /// Looks up elements of a table of 32.
  static Lane look_up(const float* table, Int i) { return static_cast<T>(table[i.v]); }
  /// out[c] is element c of each lane's quad, which starts at at(lane).
  template <class At>
  static void load_quads(const At& at, Lane (&out)[4]) {
    for (int c = 0; c < 4; ++c) out[c] = static_cast<T>(at(0)[c]);
  }
  /// Four values for every lane, in an order of their own, for sums of quads that need not be split before.
  class Quads {
   public:
    /// The quad of each lane starts at at(lane).
    template <class At>
    static Quads load(const At& at) {
      return {at(0)[0], at(0)[1], at(0)[2], at(0)[3]};
    }
    static Quads zeros() { return {0, 0, 0, 0}; }
    /// out[c] is element c of each lane's quad.
    void split(Lane (&out)[4]) const {
      for (int c = 0; c < 4; ++c) out[c] = value_[c];
    }
    friend Quads operator*(Quads q, Lane w) {
      return {q.value_[0] * w.v, q.value_[1] * w.v, q.value_[2] * w.v, q.value_[3] * w.v};
    }
    friend Quads operator+(Quads a, Quads b) {
      return {a.value_[0] + b.value_[0], a.value_[1] + b.value_[1], a.value_[2] + b.value_[2],
              a.value_[3] + b.value_[3]};
    }

   private:
    Quads(T a, T b, T c, T d) : value_{a, b, c, d} {}
    T value_[4];
  };
  friend Lane operator+(Lane a, Lane b) { return a.v + b.v; }
  friend Lane operator-(Lane a, Lane b) { return a.v - b.v; }
  friend Lane operator*(Lane a, Lane b) { return a.v * b.v; }
  friend Lane operator/(Lane a, Lane b) { return a.v / b.v; }
  friend Lane operator-(Lane a) { return -a.v; }
  friend Bool operator<(Lane a, Lane b) { return {a.v < b.v}; }
  friend Bool operator>(Lane a, Lane b) { return {a.v > b.v}; }
  friend Bool operator>=(Lane a, Lane b) { return {a.v >= b.v}; }
  friend Bool operator==(Lane a, Lane b) { return {a.v == b.v}; }
  friend Lane min(Lane a, Lane b) { return a.v < b.v ? a : b; }
  friend Lane max(Lane a, Lane b) { return a.v > b.v ? a : b; }
  friend Lane select(Bool m, Lane a, Lane b) { return m.v ? a : b; }
  friend Lane where(Bool m, Lane a) { return m.v ? a : Lane(0); }
  friend T greatest(Lane a) { return a.v; }
  friend Lane abs(Lane a) { return std::abs(a.v); }
  friend Lane sqrt(Lane a) { return std::sqrt(a.v); }
  friend Lane floor(Lane a) { return std::floor(a.v); }
  friend Int truncate(Lane a) { return static_cast<std::int32_t>(a.v); }
  friend Lane log2(Lane a) { return number::log2(a.v); }
  friend Lane coarse_log2(Lane a) { return number::coarse_log2(a.v); }
  friend Lane exp2(Lane a) { return number::exp2(a.v); }
  friend Lane exp(Lane a) { return number::exp(a.v); }
  friend Lane log(Lane a) { return number::log(a.v); }
  friend Lane sin(Lane a) { return number::sin(a.v); }
  friend Lane cos(Lane a) { return number::cos(a.v); }
  friend Lane acos(Lane a) { return number::acos(a.v); }
  friend Lane asin(Lane a) { return number::asin(a.v); }
  friend Lane pow(Lane a, Lane b) { return number::pow(a.v, b.v); }
  friend Lane atan2(Lane a, Lane b) { return number::atan2(a.v, b.v); }
  static Lane from(Int i) { return static_cast<T>(i.v); }
  /// The bits of a 32-bit float, and the float of these bits.
  friend Int as_int(Lane a) { return std::bit_cast<std::int32_t>(a.v); }
  static Lane of_bits(Int i) { return std::bit_cast<T>(i.v); }
};

using Float = Lane<float>;
using WideFloat = Float;
using OneFloat = Float;

}  // namespace zoneplate::scalar
