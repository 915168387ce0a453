// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/math/wasm_double_simd.h"
#include "zoneplate/signal/filter/row_sum.h"

namespace zoneplate::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

// Eight vectors at once: independent sums hide the latency of the additions, and each weight is read once.
template <class D>
HWY_INLINE void narrow_eight(D d, const float* const* rows, std::size_t first, const float* weights, std::size_t taps,
                             float* out, std::size_t i) {
  const std::size_t lanes = hn::Lanes(d);
  const auto product = [&](hn::Vec<D> w, std::size_t t, std::size_t v)
                           HWY_ATTR { return hn::Mul(w, hn::LoadU(d, rows[t] + first + i + v * lanes)); };
  hn::Vec<D> w = hn::Set(d, weights[0]);
  auto s0 = product(w, 0, 0), s1 = product(w, 0, 1), s2 = product(w, 0, 2), s3 = product(w, 0, 3);
  auto s4 = product(w, 0, 4), s5 = product(w, 0, 5), s6 = product(w, 0, 6), s7 = product(w, 0, 7);
  for (std::size_t t = 1; t < taps; ++t) {
    w = hn::Set(d, weights[t]);
    s0 = hn::Add(s0, product(w, t, 0)), s1 = hn::Add(s1, product(w, t, 1));
    s2 = hn::Add(s2, product(w, t, 2)), s3 = hn::Add(s3, product(w, t, 3));
    s4 = hn::Add(s4, product(w, t, 4)), s5 = hn::Add(s5, product(w, t, 5));
    s6 = hn::Add(s6, product(w, t, 6)), s7 = hn::Add(s7, product(w, t, 7));
  }
  float* to = out + i;
  hn::StoreU(s0, d, to), hn::StoreU(s1, d, to + lanes), hn::StoreU(s2, d, to + 2 * lanes);
  hn::StoreU(s3, d, to + 3 * lanes), hn::StoreU(s4, d, to + 4 * lanes), hn::StoreU(s5, d, to + 5 * lanes);
  hn::StoreU(s6, d, to + 6 * lanes), hn::StoreU(s7, d, to + 7 * lanes);
}

template <class D>
HWY_INLINE void narrow_one(D d, const float* const* rows, std::size_t first, const float* weights, std::size_t taps,
                           float* out, std::size_t i) {
  auto sum = hn::Mul(hn::Set(d, weights[0]), hn::LoadU(d, rows[0] + first + i));
  for (std::size_t t = 1; t < taps; ++t)
    sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[t]), hn::LoadU(d, rows[t] + first + i)));
  hn::StoreU(sum, d, out + i);
}

void narrow(const float* const* rows, std::size_t first, const float* weights, std::size_t taps, float* out,
            std::size_t n) {
  const hn::CappedTag<float, 8> full;
  const hn::CappedTag<float, 1> one;
  const std::size_t lanes = hn::Lanes(full);
  std::size_t i = 0;
  for (; i + 8 * lanes <= n; i += 8 * lanes) narrow_eight(full, rows, first, weights, taps, out, i);
  for (; i + lanes <= n; i += lanes) narrow_one(full, rows, first, weights, taps, out, i);
  for (; i < n; ++i) narrow_one(one, rows, first, weights, taps, out, i);
}

// Several vectors of double at once, each converted from half a vector of float.
template <class D, std::size_t count>
HWY_INLINE void wide_some(D d, const float* const* rows, std::size_t first, const double* weights, std::size_t taps,
                          float* out, std::size_t i) {
  const hn::Rebind<float, D> narrow_d;
  const std::size_t lanes = hn::Lanes(d);
  const auto product = [&](hn::Vec<D> w, std::size_t t, std::size_t v) HWY_ATTR {
    return hn::Mul(w, hn::PromoteTo(d, hn::LoadU(narrow_d, rows[t] + first + i + v * lanes)));
  };
  hn::Vec<D> w = hn::Set(d, weights[0]);
  auto s0 = product(w, 0, 0), s1 = s0, s2 = s0, s3 = s0;
  if constexpr (count == 4) s1 = product(w, 0, 1), s2 = product(w, 0, 2), s3 = product(w, 0, 3);
  for (std::size_t t = 1; t < taps; ++t) {
    w = hn::Set(d, weights[t]);
    s0 = hn::Add(s0, product(w, t, 0));
    if constexpr (count == 4) {
      s1 = hn::Add(s1, product(w, t, 1)), s2 = hn::Add(s2, product(w, t, 2)), s3 = hn::Add(s3, product(w, t, 3));
    }
  }
  float* to = out + i;
  hn::StoreU(hn::DemoteTo(narrow_d, s0), narrow_d, to);
  if constexpr (count == 4) {
    hn::StoreU(hn::DemoteTo(narrow_d, s1), narrow_d, to + lanes);
    hn::StoreU(hn::DemoteTo(narrow_d, s2), narrow_d, to + 2 * lanes);
    hn::StoreU(hn::DemoteTo(narrow_d, s3), narrow_d, to + 3 * lanes);
  }
}

void wide(const float* const* rows, std::size_t first, const double* weights, std::size_t taps, float* out,
          std::size_t n) {
  const hn::CappedTag<double, 4> full;
  const hn::CappedTag<double, 1> one;
  using Full = decltype(full);
  using One = decltype(one);
  const std::size_t lanes = hn::Lanes(full);
  std::size_t i = 0;
  for (; i + 4 * lanes <= n; i += 4 * lanes)
    wide_some<std::remove_const_t<Full>, 4>(full, rows, first, weights, taps, out, i);
  for (; i < n; ++i) wide_some<std::remove_const_t<One>, 1>(one, rows, first, weights, taps, out, i);
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE

namespace zoneplate {
template <>
const RowSumKernels PerIsa<RowSumKernels>::HWY_NAMESPACE = {.narrow = HWY_NAMESPACE::narrow,
                                                            .wide = HWY_NAMESPACE::wide};
}  // namespace zoneplate
