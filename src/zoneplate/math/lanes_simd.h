// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hwy/highway.h>

#include <cstdint>

#include "zoneplate/math/elementary_simd.h"
#include "zoneplate/math/halves_simd.h"

/// The vector equivalent of math/lanes.h with at most 8 lanes, for the instruction set of the file that includes this
/// header.
HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class FloatTag>
struct BoolVector {
  using Bool = BoolVector;
  hn::Mask<FloatTag> v;
  friend HWY_INLINE Bool operator&(Bool a, Bool b) { return {hn::And(a.v, b.v)}; }
  friend HWY_INLINE Bool operator|(Bool a, Bool b) { return {hn::Or(a.v, b.v)}; }
  friend HWY_INLINE bool all(Bool a) { return hn::AllTrue(FloatTag(), a.v); }
  friend HWY_INLINE bool none(Bool a) { return hn::AllFalse(FloatTag(), a.v); }
  friend HWY_INLINE unsigned bits_of(Bool a) {
    static_assert(hn::MaxLanes(FloatTag()) <= 8);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(FloatTag(), a.v, bits);
    return bits[0];
  }
};

template <class FloatTag>
struct IntVector {
  using IntTag = hn::RebindToSigned<FloatTag>;
  using Int = IntVector;
  using Bool = BoolVector<FloatTag>;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(IntTag()));
  hn::Vec<IntTag> v;
  IntVector() = default;
  HWY_INLINE IntVector(std::int32_t x) : v(hn::Set(IntTag(), x)) {}
  HWY_INLINE explicit IntVector(hn::Vec<IntTag> x) : v(x) {}
  static HWY_INLINE Int load(const std::int32_t* p) { return Int(hn::LoadU(IntTag(), p)); }
  HWY_INLINE void store(std::int32_t* p) const { hn::StoreU(v, IntTag(), p); }
  template <class T>
  static HWY_INLINE Int load_from(const T* p) {
    return Int(hn::PromoteTo(IntTag(), hn::LoadU(hn::Rebind<T, IntTag>(), p)));
  }
  template <class T>
  HWY_INLINE void store_as(T* p) const {
    const hn::Rebind<T, IntTag> narrow;
    hn::StoreU(hn::DemoteTo(narrow, v), narrow, p);
  }
  template <class T>
  static HWY_INLINE void store_zeros(T* p) {
    const hn::Rebind<T, IntTag> narrow;
    hn::StoreU(hn::Zero(narrow), narrow, p);
  }
  static HWY_INLINE void store_pixels(Int r, Int g, Int b, Int a, std::uint8_t* p) {
    const auto rg = hn::Or(r.v, hn::ShiftLeft<8>(g.v));
    const auto ba = hn::Or(hn::ShiftLeft<16>(b.v), hn::ShiftLeft<24>(a.v));
    const hn::Repartition<std::uint8_t, IntTag> bytes;
    hn::StoreU(hn::BitCast(bytes, hn::Or(rg, ba)), bytes, p);
  }
  HWY_INLINE void store_by_fours(Int second, std::int16_t* list, int i) const {
    const hn::Repartition<std::int16_t, IntTag> narrow;
    hn::StoreU(hn::ReorderDemote2To(narrow, v, second.v), narrow, list + 2 * i);
  }
  static HWY_INLINE Int gather(const std::int32_t* table, Int i) { return Int(hn::GatherIndex(IntTag(), table, i.v)); }
  static HWY_INLINE Int look_up(const std::int32_t* table, Int i) {
    if constexpr (lanes == 4) return gather(table, i);
    const IntTag d;
    const auto at = hn::IndicesFromVec(d, hn::And(i.v, hn::Set(d, lanes - 1)));
    const auto first = hn::TableLookupLanes(hn::LoadU(d, table), at);
    if constexpr (lanes == 16) return Int(first);
    return select(i > Int(lanes - 1), Int(hn::TableLookupLanes(hn::LoadU(d, table + lanes), at)), Int(first));
  }
  HWY_INLINE std::int32_t first() const { return hn::GetLane(v); }
  HWY_INLINE bool equals(Int other) const { return hn::AllTrue(IntTag(), hn::Eq(v, other.v)); }
  HWY_INLINE bool is_uniform() const { return hn::AllTrue(IntTag(), hn::Eq(v, hn::Set(IntTag(), hn::GetLane(v)))); }
  friend HWY_INLINE Int operator+(Int a, Int b) { return Int(hn::Add(a.v, b.v)); }
  friend HWY_INLINE Int operator-(Int a, Int b) { return Int(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE Int operator*(Int a, Int b) { return Int(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE Bool operator<(Int a, Int b) { return {hn::RebindMask(FloatTag(), hn::Lt(a.v, b.v))}; }
  friend HWY_INLINE Bool operator>(Int a, Int b) { return {hn::RebindMask(FloatTag(), hn::Gt(a.v, b.v))}; }
  friend HWY_INLINE Bool operator==(Int a, Int b) { return {hn::RebindMask(FloatTag(), hn::Eq(a.v, b.v))}; }
  friend HWY_INLINE Int operator&(Int a, Int b) { return Int(hn::And(a.v, b.v)); }
  friend HWY_INLINE Int operator|(Int a, Int b) { return Int(hn::Or(a.v, b.v)); }
  template <int bits>
  HWY_INLINE Int shifted_right() const {
    return Int(hn::ShiftRight<bits>(v));
  }
  friend HWY_INLINE Int min(Int a, Int b) { return Int(hn::Min(a.v, b.v)); }
  friend HWY_INLINE Int max(Int a, Int b) { return Int(hn::Max(a.v, b.v)); }
  friend HWY_INLINE Int select(Bool m, Int a, Int b) {
    return Int(hn::IfThenElse(hn::RebindMask(IntTag(), m.v), a.v, b.v));
  }
  friend HWY_INLINE Int color_difference(Int a, Int b) {
    const IntTag d;
    const hn::Repartition<std::uint8_t, IntTag> bytes;
    const auto x = hn::BitCast(bytes, a.v), y = hn::BitCast(bytes, b.v);
    const auto each = hn::BitCast(d, hn::Or(hn::SaturatedSub(x, y), hn::SaturatedSub(y, x)));
    const auto mask = hn::Set(d, 255);
    const auto red = hn::And(each, mask), green = hn::And(hn::ShiftRight<8>(each), mask);
    return Int(hn::Max(red, hn::Max(green, hn::And(hn::ShiftRight<16>(each), mask))));
  }
  friend HWY_INLINE Int where(Bool m, Int a) { return Int(hn::IfThenElseZero(hn::RebindMask(IntTag(), m.v), a.v)); }
};

template <class FloatTag>
struct FloatVector {
  using Float = FloatVector;
  using Bool = BoolVector<FloatTag>;
  using Int = IntVector<FloatTag>;
  using Four = FloatVector<hn::CappedTag<float, 4>>;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(FloatTag()));
  hn::Vec<FloatTag> v;
  FloatVector() = default;
  HWY_INLINE FloatVector(float x) : v(hn::Set(FloatTag(), x)) {}
  HWY_INLINE explicit FloatVector(hn::Vec<FloatTag> x) : v(x) {}
  static HWY_INLINE Float load(const float* p) { return Float(hn::LoadU(FloatTag(), p)); }
  HWY_INLINE void store(float* p) const { hn::StoreU(v, FloatTag(), p); }
  static HWY_INLINE void load_fours(const float* p, Float (&v)[4]) {
    hn::LoadInterleaved4(FloatTag(), p, v[0].v, v[1].v, v[2].v, v[3].v);
  }
  static HWY_INLINE void store_fours(const Float (&v)[4], float* p) {
    hn::StoreInterleaved4(v[0].v, v[1].v, v[2].v, v[3].v, FloatTag(), p);
  }
  static HWY_INLINE Float gather(const float* table, Int i) { return Float(hn::GatherIndex(FloatTag(), table, i.v)); }
  static HWY_INLINE Float look_up(const float* table, Int i) {
    if constexpr (lanes < 16) return gather(table, i);
    const FloatTag d;
    const typename Int::IntTag whole;
    const auto at = hn::IndicesFromVec(d, hn::And(i.v, hn::Set(whole, lanes - 1)));
    const auto half = [&](int first) HWY_ATTR { return Float(hn::TableLookupLanes(hn::LoadU(d, table + first), at)); };
    return select(i > Int(lanes - 1), half(16), half(0));
  }
  /// Register k has the quads of lanes k and k + 4.
  class Quads {
   public:
    template <class At>
    static HWY_INLINE Quads load(const At& at) {
      const FloatTag d;
      const auto quad = [&](int lane) HWY_ATTR { return hn::LoadU(hn::FixedTag<float, 4>(), at(lane)); };
      return {every_fourth_quad(d, quad, 0), every_fourth_quad(d, quad, 1), every_fourth_quad(d, quad, 2),
              every_fourth_quad(d, quad, 3)};
    }
    static HWY_INLINE Quads zeros() {
      const auto zero = hn::Zero(FloatTag());
      return {zero, zero, zero, zero};
    }
    HWY_INLINE void split(Float (&out)[4]) const {
      const FloatTag d;
      const auto xy02 = hn::InterleaveLower(d, r0, r2), xy13 = hn::InterleaveLower(d, r1, r3);
      const auto zw02 = hn::InterleaveUpper(d, r0, r2), zw13 = hn::InterleaveUpper(d, r1, r3);
      out[0].v = hn::InterleaveLower(d, xy02, xy13), out[1].v = hn::InterleaveUpper(d, xy02, xy13);
      out[2].v = hn::InterleaveLower(d, zw02, zw13), out[3].v = hn::InterleaveUpper(d, zw02, zw13);
    }
    friend HWY_INLINE Quads operator*(Quads q, Float w) {
      return {hn::Mul(q.r0, hn::Broadcast<0>(w.v)), hn::Mul(q.r1, hn::Broadcast<1>(w.v)),
              hn::Mul(q.r2, hn::Broadcast<2>(w.v)), hn::Mul(q.r3, hn::Broadcast<3>(w.v))};
    }
    friend HWY_INLINE Quads operator+(Quads a, Quads b) {
      return {hn::Add(a.r0, b.r0), hn::Add(a.r1, b.r1), hn::Add(a.r2, b.r2), hn::Add(a.r3, b.r3)};
    }

   private:
    using Register = hn::Vec<FloatTag>;
    HWY_INLINE Quads(Register a, Register b, Register c, Register d) : r0(a), r1(b), r2(c), r3(d) {}
    Register r0, r1, r2, r3;
  };
  template <class At>
  static HWY_INLINE void load_quads(const At& at, Float (&out)[4]) {
    Quads::load(at).split(out);
  }
  friend HWY_INLINE Float operator+(Float a, Float b) { return Float(hn::Add(a.v, b.v)); }
  friend HWY_INLINE Float operator-(Float a, Float b) { return Float(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE Float operator*(Float a, Float b) { return Float(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE Float operator/(Float a, Float b) { return Float(hn::Div(a.v, b.v)); }
  friend HWY_INLINE Float operator-(Float a) { return Float(hn::Neg(a.v)); }
  friend HWY_INLINE Bool operator<(Float a, Float b) { return {hn::Lt(a.v, b.v)}; }
  friend HWY_INLINE Bool operator>(Float a, Float b) { return {hn::Gt(a.v, b.v)}; }
  friend HWY_INLINE Bool operator>=(Float a, Float b) { return {hn::Ge(a.v, b.v)}; }
  friend HWY_INLINE Bool operator==(Float a, Float b) { return {hn::Eq(a.v, b.v)}; }
#if HWY_ARCH_X86
  friend HWY_INLINE Float min(Float a, Float b) { return Float(hn::Min(a.v, b.v)); }
  friend HWY_INLINE Float max(Float a, Float b) { return Float(hn::Max(a.v, b.v)); }
#else  // on other architectures, minima propagate NaN
  friend HWY_INLINE Float min(Float a, Float b) { return Float(hn::IfThenElse(hn::Lt(a.v, b.v), a.v, b.v)); }
  friend HWY_INLINE Float max(Float a, Float b) { return Float(hn::IfThenElse(hn::Gt(a.v, b.v), a.v, b.v)); }
#endif
  friend HWY_INLINE Float select(Bool m, Float a, Float b) { return Float(hn::IfThenElse(m.v, a.v, b.v)); }
  friend HWY_INLINE Float where(Bool m, Float a) { return Float(hn::IfThenElseZero(m.v, a.v)); }
  friend HWY_INLINE float greatest(Float a) { return hn::GetLane(hn::MaxOfLanes(FloatTag(), a.v)); }
  friend HWY_INLINE Float abs(Float a) { return Float(hn::Abs(a.v)); }
  friend HWY_INLINE Float sqrt(Float a) { return Float(hn::Sqrt(a.v)); }
  friend HWY_INLINE Float floor(Float a) { return Float(hn::Floor(a.v)); }
  friend HWY_INLINE Int truncate(Float a) { return Int(truncated(FloatTag(), a.v)); }
  friend HWY_INLINE Float log2(Float a) { return Float(HWY_NAMESPACE::log2(FloatTag(), a.v)); }
  friend HWY_INLINE Float coarse_log2(Float a) { return Float(HWY_NAMESPACE::coarse_log2(FloatTag(), a.v)); }
  friend HWY_INLINE Float exp2(Float a) { return Float(HWY_NAMESPACE::exp2(FloatTag(), a.v)); }
  friend HWY_INLINE Float pow(Float a, Float b) { return Float(HWY_NAMESPACE::pow(FloatTag(), a.v, b.v)); }
  friend HWY_INLINE Float exp(Float a) { return Float(HWY_NAMESPACE::exp(FloatTag(), a.v)); }
  friend HWY_INLINE Float log(Float a) { return Float(HWY_NAMESPACE::log(FloatTag(), a.v)); }
  friend HWY_INLINE Float sin(Float a) { return Float(HWY_NAMESPACE::sin(FloatTag(), a.v)); }
  friend HWY_INLINE Float cos(Float a) { return Float(HWY_NAMESPACE::cos(FloatTag(), a.v)); }
  friend HWY_INLINE Float acos(Float a) { return Float(HWY_NAMESPACE::acos(FloatTag(), a.v)); }
  friend HWY_INLINE Float asin(Float a) { return Float(HWY_NAMESPACE::asin(FloatTag(), a.v)); }
  friend HWY_INLINE Float atan2(Float a, Float b) { return Float(HWY_NAMESPACE::atan2(FloatTag(), a.v, b.v)); }
  static HWY_INLINE Float from(Int i) { return Float(hn::ConvertTo(FloatTag(), i.v)); }
  friend HWY_INLINE Int as_int(Float a) { return Int(hn::BitCast(typename Int::IntTag(), a.v)); }
  static HWY_INLINE Float of_bits(Int i) { return Float(hn::BitCast(FloatTag(), i.v)); }
};

/// As many lanes as a group of fragments has at most, as many as a vector has, four, and one for the rests of rows.
using Float = FloatVector<hn::CappedTag<float, 8>>;
using WideFloat = FloatVector<hn::CappedTag<float, 16>>;
using FourFloats = FloatVector<hn::CappedTag<float, 4>>;
using OneFloat = FloatVector<hn::CappedTag<float, 1>>;

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
