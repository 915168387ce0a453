// SPDX-License-Identifier: Apache-2.0
// The vector equivalents of math/elementary.h, included by *_simd.cpp files only: the same operations in the same
// order, and therefore the same bits. `d` is a descriptor of float lanes; edges and errors are those of the scalar
// functions.
#if defined(ZONEPLATE_MATH_ELEMENTARY_SIMD_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ZONEPLATE_MATH_ELEMENTARY_SIMD_H_
#undef ZONEPLATE_MATH_ELEMENTARY_SIMD_H_
#else
#define ZONEPLATE_MATH_ELEMENTARY_SIMD_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

#include "zoneplate/math/elementary_constants.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class D>
using Ints = hn::Vec<hn::RebindToSigned<D>>;

/// a + b × c with separate rounding of product and sum.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V add_product(D, V a, V b, V c) {
  return hn::Add(a, hn::Mul(b, c));
}

/// c0 + z (c1 + z (c2 + ...)).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V horner(D d, V z, const float (&c)[3]) {
  return add_product(d, hn::Set(d, c[0]), z, add_product(d, hn::Set(d, c[1]), z, hn::Set(d, c[2])));
}

/// x truncated to an integer. Requires |x| < 2^31: x86 then needs one instruction, whereas ConvertTo also handles other
/// values.
template <class D>
HWY_INLINE Ints<D> truncated(D, hn::Vec<D> x) {
  const hn::RebindToSigned<D> di;
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_SSSE3
  if constexpr (hn::MaxLanes(D()) == 4) return Ints<D>{_mm_cvttps_epi32(x.raw)};
#if HWY_TARGET <= HWY_AVX2
  if constexpr (hn::MaxLanes(D()) == 8) return Ints<D>{_mm256_cvttps_epi32(x.raw)};
#endif
#if HWY_TARGET <= HWY_AVX3
  if constexpr (hn::MaxLanes(D()) == 16) return Ints<D>{_mm512_cvttps_epi32(x.raw)};
#endif
#endif
  return hn::ConvertTo(di, x);
}

template <class D>
HWY_INLINE Ints<D> nearest(D d, hn::Vec<D> x) {
  const hn::RebindToSigned<D> di;
  const auto shifted = hn::Add(x, hn::Set(d, elementary::round_shift));
  return hn::Sub(hn::BitCast(di, shifted), hn::Set(di, elementary::round_shift_bits));
}

template <class D>
HWY_INLINE hn::Vec<D> scaled(D d, hn::Vec<D> value, Ints<D> k) {
  const hn::RebindToSigned<D> di;
  return hn::BitCast(d, hn::Add(hn::BitCast(di, value), hn::ShiftLeft<23>(k)));
}

template <class D>
struct Log {
  hn::Vec<D> e, s;
};
template <class D>
HWY_INLINE Log<D> split_log(D d, hn::Vec<D> x) {
  const hn::RebindToSigned<D> di;
  const auto bits = hn::BitCast(di, x);
  const auto e = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, elementary::root_half_bits)));
  const auto m = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(e)));
  const auto less = hn::Sub(m, hn::Set(d, 1.0f));
  return {hn::ConvertTo(d, e), hn::Div(less, hn::Add(less, hn::Set(d, 2.0f)))};
}

template <class D>
struct Angle {
  Ints<D> quarter;
  hn::Vec<D> r;
};
template <class D>
HWY_INLINE Angle<D> split_angle(D d, hn::Vec<D> x) {
  const auto low = hn::Set(d, -elementary::max_angle), high = hn::Set(d, elementary::max_angle);
  x = hn::IfThenElse(hn::Gt(x, low), x, low);
  x = hn::IfThenElse(hn::Lt(x, high), x, high);
  const auto quarter = nearest(d, hn::Mul(x, hn::Set(d, elementary::two_over_pi)));
  const auto k = hn::ConvertTo(d, quarter);
  for (const float part : elementary::half_pi_parts) x = hn::Sub(x, hn::Mul(k, hn::Set(d, part)));
  return {quarter, x};
}

template <class D>
HWY_INLINE hn::Vec<D> sin_quarter(D d, Ints<D> quarter, hn::Vec<D> r) {
  const hn::RebindToSigned<D> di;
  const auto z = hn::Mul(r, r);
  const auto sin = add_product(d, r, r, hn::Mul(z, horner(d, z, elementary::sin_c)));
  const auto cos = add_product(d, hn::Sub(hn::Set(d, 1.0f), hn::Mul(hn::Set(d, 0.5f), z)), hn::Mul(z, z),
                               horner(d, z, elementary::cos_c));
  const auto is_odd = hn::TestBit(quarter, hn::Set(di, 1));
  const auto v = hn::IfThenElse(hn::RebindMask(d, is_odd), cos, sin);
  const auto sign = hn::ShiftLeft<30>(hn::And(quarter, hn::Set(di, 2)));
  return hn::Xor(v, hn::BitCast(d, sign));
}

/// value(x); 0 below `low`, and infinity from `high` on.
template <class D, class Value>
HWY_INLINE hn::Vec<D> between_edges(D d, hn::Vec<D> x, float low, float high, Value value) {
  const auto low_edge = hn::Set(d, low), high_edge = hn::Set(d, high);
  const auto is_low = hn::Not(hn::Ge(x, low_edge));
  const auto is_high = hn::Ge(x, high_edge);
  const auto inside = value(hn::IfThenElse(hn::Or(is_low, is_high), low_edge, x));
  return hn::IfThenElse(is_high, hn::BitCast(d, hn::Set(hn::RebindToSigned<D>(), 0x7f800000)),
                        hn::IfThenZeroElse(is_low, inside));
}

template <class D>
HWY_INLINE hn::Vec<D> exp2(D d, hn::Vec<D> x) {
  return between_edges(d, x, elementary::exp2_low, elementary::exp2_high, [=](hn::Vec<D> inside) HWY_ATTR {
    const auto k = nearest(d, inside);
    const auto f = hn::Sub(inside, hn::ConvertTo(d, k));
    const auto f2 = hn::Mul(f, f);
    const float(&c)[6] = elementary::exp2_c;
    const auto low = add_product(d, hn::Set(d, c[0]), hn::Set(d, c[1]), f);
    const auto middle = add_product(d, hn::Set(d, c[2]), hn::Set(d, c[3]), f);
    const auto high = add_product(d, hn::Set(d, c[4]), hn::Set(d, c[5]), f);
    const auto sum = add_product(d, low, f2, add_product(d, middle, f2, high));
    return scaled(d, add_product(d, hn::Set(d, 1.0f), f, sum), k);
  });
}

template <class D>
HWY_INLINE hn::Vec<D> exp(D d, hn::Vec<D> x) {
  return between_edges(d, x, elementary::exp_low, elementary::exp_high, [=](hn::Vec<D> inside) HWY_ATTR {
    const auto k = nearest(d, hn::Mul(inside, hn::Set(d, elementary::log2_e)));
    const auto n = hn::ConvertTo(d, k);
    const auto r = hn::Sub(hn::Sub(inside, hn::Mul(n, hn::Set(d, elementary::ln2_head))),
                           hn::Mul(n, hn::Set(d, elementary::ln2_tail)));
    const auto r2 = hn::Mul(r, r);
    const float(&c)[5] = elementary::exp_c;
    const auto low = add_product(d, hn::Set(d, c[0]), hn::Set(d, c[1]), r);
    const auto middle = add_product(d, hn::Set(d, c[2]), hn::Set(d, c[3]), r);
    const auto sum = add_product(d, low, r2, add_product(d, middle, r2, hn::Set(d, c[4])));
    return scaled(d, hn::Add(hn::Set(d, 1.0f), add_product(d, r, r2, sum)), k);
  });
}

/// `value` if x is at least the least normal number, else -infinity.
template <class D>
HWY_INLINE hn::Vec<D> log_or_edge(D d, hn::Vec<D> x, hn::Vec<D> value) {
  const auto edge = hn::BitCast(d, hn::Set(hn::RebindToSigned<D>(), static_cast<std::int32_t>(0xff800000)));
  return hn::IfThenElse(hn::Ge(x, hn::Set(d, elementary::min_normal)), value, edge);
}

template <class D>
HWY_INLINE hn::Vec<D> log2(D d, hn::Vec<D> x) {
  const Log<D> l = split_log(d, x);
  const auto z = hn::Mul(l.s, l.s);
  const auto tail = add_product(d, hn::Set(d, elementary::two_log2_e_tail), z, horner(d, z, elementary::log2_c));
  const auto m = add_product(d, hn::Mul(l.s, hn::Set(d, elementary::two_log2_e_head)), l.s, tail);
  return log_or_edge(d, x, hn::Add(l.e, m));
}

template <class D>
HWY_INLINE hn::Vec<D> coarse_log2(D d, hn::Vec<D> x) {
  const hn::RebindToSigned<D> di;
  const float(&c)[3] = elementary::coarse_log2_c;
  const auto bits = hn::BitCast(di, x);
  const auto e = hn::ConvertTo(d, hn::Sub(hn::ShiftRight<23>(bits), hn::Set(di, 127)));
  const auto m = hn::Or(hn::And(bits, hn::Set(di, 0x7fffff)), hn::Set(di, 0x3f800000));
  const auto one = hn::Set(d, 1.0f), t = hn::Sub(hn::BitCast(d, m), one);
  const auto line = add_product(d, hn::Set(d, c[0]), t, hn::Set(d, c[1]));
  const auto q = add_product(d, line, hn::Mul(t, t), hn::Set(d, c[2]));
  return hn::Add(e, add_product(d, t, hn::Mul(t, hn::Sub(t, one)), q));
}

template <class D>
HWY_INLINE hn::Vec<D> log(D d, hn::Vec<D> x) {
  const Log<D> l = split_log(d, x);
  const auto z = hn::Mul(l.s, l.s);
  const auto tail =
      add_product(d, hn::Mul(l.e, hn::Set(d, elementary::ln2_tail)), l.s, hn::Mul(z, horner(d, z, elementary::log_c)));
  const auto m = add_product(d, tail, hn::Set(d, 2.0f), l.s);
  return log_or_edge(d, x, hn::Add(hn::Mul(l.e, hn::Set(d, elementary::ln2_head)), m));
}

template <class D>
HWY_INLINE hn::Vec<D> pow(D d, hn::Vec<D> x, hn::Vec<D> y) {
  const auto power = exp2(d, hn::Mul(y, log2(d, x)));
  return hn::IfThenElse(hn::Eq(y, hn::Zero(d)), hn::Set(d, 1.0f), power);
}

template <class D>
HWY_INLINE hn::Vec<D> sin(D d, hn::Vec<D> x) {
  const Angle<D> a = split_angle(d, x);
  return sin_quarter(d, a.quarter, a.r);
}

template <class D>
HWY_INLINE hn::Vec<D> cos(D d, hn::Vec<D> x) {
  const Angle<D> a = split_angle(d, x);
  return sin_quarter(d, hn::Add(a.quarter, hn::Set(hn::RebindToSigned<D>(), 1)), a.r);
}

template <class D>
HWY_INLINE hn::Vec<D> atan2(D d, hn::Vec<D> y, hn::Vec<D> x) {
  const auto zero = hn::Zero(d);
  const auto ax = hn::Abs(x), ay = hn::Abs(y);
  const auto is_steep = hn::Gt(ay, ax);
  const auto a = hn::IfThenElse(is_steep, ax, ay), b = hn::IfThenElse(is_steep, ay, ax);
  const auto is_turned = hn::Gt(a, hn::Mul(hn::Set(d, elementary::tan_eighth_pi), b));
  const auto above = hn::IfThenElse(is_turned, hn::Sub(a, b), a);
  const auto below = hn::IfThenElse(is_turned, hn::Add(a, b), b);
  const auto t = hn::IfThenElseZero(hn::Gt(below, zero), hn::Div(above, below));
  const auto z = hn::Mul(t, t);
  const float(&c)[5] = elementary::atan_c;
  const auto high = add_product(d, hn::Set(d, c[3]), z, hn::Set(d, c[4]));
  const auto middle = add_product(d, hn::Set(d, c[1]), z, add_product(d, hn::Set(d, c[2]), z, high));
  const auto odd = add_product(d, hn::Set(d, c[0]), z, middle);
  const auto turn = hn::IfThenElseZero(is_turned, hn::Set(d, elementary::quarter_pi));
  const auto octant = hn::Add(turn, add_product(d, t, t, hn::Mul(z, odd)));
  const auto quadrant = hn::IfThenElse(is_steep, hn::Sub(hn::Set(d, elementary::half_pi), octant), octant);
  const hn::RebindToSigned<D> di;
  const auto is_behind = hn::RebindMask(d, hn::Lt(hn::BitCast(di, x), hn::Zero(di)));
  return hn::CopySign(hn::IfThenElse(is_behind, hn::Sub(hn::Set(d, elementary::pi), quadrant), quadrant), y);
}

/// x clamped to [-1, 1].
template <class D>
HWY_INLINE hn::Vec<D> clamped_cosine(D d, hn::Vec<D> x) {
  const auto low = hn::Set(d, -1.0f), high = hn::Set(d, 1.0f);
  x = hn::IfThenElse(hn::Gt(x, low), x, low);
  return hn::IfThenElse(hn::Lt(x, high), x, high);
}

template <class D>
HWY_INLINE hn::Vec<D> acos(D d, hn::Vec<D> x) {
  x = clamped_cosine(d, x);
  const auto one = hn::Set(d, 1.0f);
  return atan2(d, hn::Sqrt(hn::Mul(hn::Sub(one, x), hn::Add(one, x))), x);
}

template <class D>
HWY_INLINE hn::Vec<D> asin(D d, hn::Vec<D> x) {
  x = clamped_cosine(d, x);
  const auto one = hn::Set(d, 1.0f);
  return atan2(d, x, hn::Sqrt(hn::Mul(hn::Sub(one, x), hn::Add(one, x))));
}

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
