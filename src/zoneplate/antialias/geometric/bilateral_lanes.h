// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/geometric/bilateral.h"
#include "zoneplate/math/for_row.h"

/// The kernel of antialias/geometric/bilateral.h over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// The weight of one point's colour for another point. Each is a normal and a distance, all 0 for an empty point.
template <class F>
[[gnu::always_inline]] inline F likeness(const F (&a)[4], const F (&b)[4], const BilateralScales& scales) {
  const F zero(0.0f), one(1.0f);
  const auto a_empty = (a[0] == zero) & (a[1] == zero) & (a[2] == zero);
  const auto b_empty = (b[0] == zero) & (b[1] == zero) & (b[2] == zero);
  const F far = abs(a[3] - b[3]) / min(b[3], a[3]);
  const F turned = one - (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
  const F weight = exp(F(-scales.scale) * max(F(scales.depth) * far, turned));
  return select(a_empty | b_empty, where(a_empty & b_empty, one), weight);
}

template <class Full, class One>
[[gnu::flatten]] void add_shaded(const float* sample, const float* centre, const float* color,
                                 const BilateralScales& scales, float* sum, float* weight, std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) {
    F a[4], b[4], c[4], s[4];
    F::load_fours(sample + 4 * i, a), F::load_fours(centre + 4 * i, b);
    const F w = likeness(a, b, scales);
    F::load_fours(color + 4 * i, c), F::load_fours(sum + 4 * i, s);
    for (int k = 0; k < 4; ++k) s[k] = s[k] + c[k] * w;
    F::store_fours(s, sum + 4 * i);
    (F::load(weight + i) + w).store(weight + i);
  });
}

template <class Full, class One>
constexpr SraaKernels bilateral() {
  return {.add = &add_shaded<Full, One>};
}

}  // namespace zoneplate::stages
