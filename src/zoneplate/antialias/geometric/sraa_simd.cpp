#include <hwy/highway.h>

#include "zoneplate/antialias/geometric/sraa_kernels.h"
#include "zoneplate/antialias/post/edges_simd.h"
#include "zoneplate/math/elementary_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

/// Four floats a pixel, channel by channel.
template <class D>
struct Pixels {
  hn::Vec<D> r, g, b, a;
  HWY_INLINE Pixels(D d, const float* at) { hn::LoadInterleaved4(d, at, r, g, b, a); }
};

template <class D>
HWY_INLINE auto is_empty(D d, const Pixels<D>& p) {
  const auto zero = hn::Zero(d);
  return hn::And(hn::Eq(p.r, zero), hn::And(hn::Eq(p.g, zero), hn::Eq(p.b, zero)));
}

template <class D>
HWY_INLINE hn::Vec<D> likeness(D d, const Pixels<D>& p, const Pixels<D>& q, const BilateralScales& scales) {
  const auto one = hn::Set(d, 1.0f);
  const auto nearer = hn::IfThenElse(hn::Lt(q.a, p.a), q.a, p.a);
  const auto far = hn::Div(hn::Abs(hn::Sub(p.a, q.a)), nearer);
  const auto cosine = hn::Add(hn::Add(hn::Mul(p.r, q.r), hn::Mul(p.g, q.g)), hn::Mul(p.b, q.b));
  const auto turned = hn::Sub(one, cosine), apart = hn::Mul(hn::Set(d, scales.depth), far);
  const auto unlike = hn::IfThenElse(hn::Lt(turned, apart), apart, turned);
  const auto weight = exp(d, hn::Mul(hn::Set(d, -scales.scale), unlike));
  const auto p_empty = is_empty(d, p), q_empty = is_empty(d, q);
  const auto of_empty = hn::IfThenElseZero(hn::And(p_empty, q_empty), one);
  return hn::IfThenElse(hn::Or(p_empty, q_empty), of_empty, weight);
}

template <class D>
HWY_INLINE void add_some(D d, const float* sample, const float* centre, const float* color,
                         const BilateralScales& scales, float* sum, float* weight, std::size_t i) {
  const auto w = likeness(d, Pixels<D>(d, sample + 4 * i), Pixels<D>(d, centre + 4 * i), scales);
  const Pixels<D> c(d, color + 4 * i), s(d, sum + 4 * i);
  hn::StoreInterleaved4(add_product(d, s.r, c.r, w), add_product(d, s.g, c.g, w), add_product(d, s.b, c.b, w),
                        add_product(d, s.a, c.a, w), d, sum + 4 * i);
  hn::StoreU(hn::Add(hn::LoadU(d, weight + i), w), d, weight + i);
}

void add(const float* sample, const float* centre, const float* color, const BilateralScales& scales, float* sum,
         float* weight, std::size_t n) {
  for_lanes(n, [&](auto d, std::size_t i) HWY_ATTR { add_some(d, sample, centre, color, scales, sum, weight, i); });
}

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const SraaKernels PerIsa<SraaKernels>::HWY_NAMESPACE = {.add = HWY_NAMESPACE::add};
}  // namespace zoneplate
