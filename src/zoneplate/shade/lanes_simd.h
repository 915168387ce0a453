#pragma once

#include <hwy/highway.h>

#include <cstdint>

#include "zoneplate/math/elementary_simd.h"

/// The vector twin of shade/lanes.h, of at most 8 lanes, for the instruction set of the file that includes it.
HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, 8>;
using IntTag = hn::RebindToSigned<FloatTag>;

struct Bool {
  hn::Mask<FloatTag> v;
  friend HWY_INLINE Bool operator&(Bool a, Bool b) { return {hn::And(a.v, b.v)}; }
  friend HWY_INLINE Bool operator|(Bool a, Bool b) { return {hn::Or(a.v, b.v)}; }
};

struct Int {
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(IntTag()));
  hn::Vec<IntTag> v;
  HWY_INLINE Int(std::int32_t x) : v(hn::Set(IntTag(), x)) {}
  HWY_INLINE explicit Int(hn::Vec<IntTag> x) : v(x) {}
  static HWY_INLINE Int load(const std::int32_t* p) { return Int(hn::LoadU(IntTag(), p)); }
  HWY_INLINE void store(std::int32_t* p) const { hn::StoreU(v, IntTag(), p); }
  static HWY_INLINE Int gather(const std::int32_t* table, Int i) { return Int(hn::GatherIndex(IntTag(), table, i.v)); }
  HWY_INLINE std::int32_t first() const { return hn::GetLane(v); }
  HWY_INLINE bool is_uniform() const { return hn::AllTrue(IntTag(), hn::Eq(v, hn::Set(IntTag(), hn::GetLane(v)))); }
  friend HWY_INLINE Int operator+(Int a, Int b) { return Int(hn::Add(a.v, b.v)); }
  friend HWY_INLINE Int operator-(Int a, Int b) { return Int(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE Int operator*(Int a, Int b) { return Int(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE Bool operator<(Int a, Int b) { return {hn::RebindMask(FloatTag(), hn::Lt(a.v, b.v))}; }
  friend HWY_INLINE Bool operator>(Int a, Int b) { return {hn::RebindMask(FloatTag(), hn::Gt(a.v, b.v))}; }
  friend HWY_INLINE Int min(Int a, Int b) { return Int(hn::Min(a.v, b.v)); }
  friend HWY_INLINE Int max(Int a, Int b) { return Int(hn::Max(a.v, b.v)); }
  friend HWY_INLINE Int select(Bool m, Int a, Int b) {
    return Int(hn::IfThenElse(hn::RebindMask(IntTag(), m.v), a.v, b.v));
  }
};

struct Float {
  using Bool = HWY_NAMESPACE::Bool;
  using Int = HWY_NAMESPACE::Int;
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(FloatTag()));
  hn::Vec<FloatTag> v;
  Float() = default;
  HWY_INLINE Float(float x) : v(hn::Set(FloatTag(), x)) {}
  HWY_INLINE explicit Float(hn::Vec<FloatTag> x) : v(x) {}
  static HWY_INLINE Float load(const float* p) { return Float(hn::LoadU(FloatTag(), p)); }
  HWY_INLINE void store(float* p) const { hn::StoreU(v, FloatTag(), p); }
  static HWY_INLINE Float gather(const float* table, Int i) { return Float(hn::GatherIndex(FloatTag(), table, i.v)); }
  friend HWY_INLINE Float operator+(Float a, Float b) { return Float(hn::Add(a.v, b.v)); }
  friend HWY_INLINE Float operator-(Float a, Float b) { return Float(hn::Sub(a.v, b.v)); }
  friend HWY_INLINE Float operator*(Float a, Float b) { return Float(hn::Mul(a.v, b.v)); }
  friend HWY_INLINE Float operator/(Float a, Float b) { return Float(hn::Div(a.v, b.v)); }
  friend HWY_INLINE Float operator-(Float a) { return Float(hn::Neg(a.v)); }
  friend HWY_INLINE Bool operator<(Float a, Float b) { return {hn::Lt(a.v, b.v)}; }
  friend HWY_INLINE Bool operator>(Float a, Float b) { return {hn::Gt(a.v, b.v)}; }
  friend HWY_INLINE Float min(Float a, Float b) { return Float(hn::Min(a.v, b.v)); }
  friend HWY_INLINE Float max(Float a, Float b) { return Float(hn::Max(a.v, b.v)); }
  friend HWY_INLINE Float select(Bool m, Float a, Float b) { return Float(hn::IfThenElse(m.v, a.v, b.v)); }
  friend HWY_INLINE Float sqrt(Float a) { return Float(hn::Sqrt(a.v)); }
  friend HWY_INLINE Float floor(Float a) { return Float(hn::Floor(a.v)); }
  friend HWY_INLINE Int truncate(Float a) { return Int(hn::ConvertTo(IntTag(), a.v)); }
  friend HWY_INLINE Float log2(Float a) { return Float(HWY_NAMESPACE::log2(FloatTag(), a.v)); }
  friend HWY_INLINE Float exp2(Float a) { return Float(HWY_NAMESPACE::exp2(FloatTag(), a.v)); }
  friend HWY_INLINE Float pow(Float a, Float b) { return Float(HWY_NAMESPACE::pow(FloatTag(), a.v, b.v)); }
  static HWY_INLINE Float from(Int i) { return Float(hn::ConvertTo(FloatTag(), i.v)); }
};

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
