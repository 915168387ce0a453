// The vector twins of image/transfer.h, included by *_simd.cpp files only: the same bits.
#if defined(ZONEPLATE_IMAGE_TRANSFER_SIMD_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ZONEPLATE_IMAGE_TRANSFER_SIMD_H_
#undef ZONEPLATE_IMAGE_TRANSFER_SIMD_H_
#else
#define ZONEPLATE_IMAGE_TRANSFER_SIMD_H_
#endif

#include "zoneplate/image/transfer_constants.h"
#include "zoneplate/math/elementary_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// x clamped to [0, 1]; NaN gives 0.
template <class D>
HWY_INLINE hn::Vec<D> clamp_unit(D d, hn::Vec<D> x) {
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0f);
#if HWY_ARCH_X86  // where the maximum of NaN and x is the second operand
  return hn::Min(hn::Max(x, zero), one);
#else
  x = hn::IfThenElse(hn::Gt(x, zero), x, zero);
  return hn::IfThenElse(hn::Lt(x, one), x, one);
#endif
}

template <class D>
HWY_INLINE hn::Vec<D> encode_srgb(D d, hn::Vec<D> linear) {
  const auto x = clamp_unit(d, linear);
  const auto curve = hn::Mul(hn::Set(d, srgb::scale), pow(d, x, hn::Set(d, srgb::inverse_power)));
  const auto line = hn::Mul(hn::Set(d, srgb::slope), x);
  return hn::IfThenElse(hn::Le(x, hn::Set(d, srgb::linear_cutoff)), line, hn::Sub(curve, hn::Set(d, srgb::offset)));
}

template <class D>
HWY_INLINE hn::Vec<D> decode_srgb(D d, hn::Vec<D> code) {
  const auto x = clamp_unit(d, code);
  const auto base = hn::Div(hn::Add(x, hn::Set(d, srgb::offset)), hn::Set(d, srgb::scale));
  const auto line = hn::Div(x, hn::Set(d, srgb::slope));
  return hn::IfThenElse(hn::Le(x, hn::Set(d, srgb::code_cutoff)), line, pow(d, base, hn::Set(d, srgb::power)));
}

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
