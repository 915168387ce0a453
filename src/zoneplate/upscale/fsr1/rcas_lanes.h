// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/fsr1/rcas.h"
#include "zoneplate/upscale/fsr1/reciprocal_lanes.h"

/// RcasKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

template <class F>
struct RcasPixels {
  F above[4], left[4], centre[4], right[4], below[4];
};

/// Half of the share by which a pixel deviates from its neighbours' mean, of the range of the five: 1 for the worst
/// outlier.
template <bool is_exact, class F>
[[gnu::always_inline]] inline F noise_factor(const RcasPixels<F>& p) {
  const auto luma = [](const F(&c)[4]) { return c[2] * F(0.5f) + (c[0] * F(0.5f) + c[1]); };
  const F b = luma(p.above), d = luma(p.left), e = luma(p.centre), f = luma(p.right), h = luma(p.below);
  const F quarter = F(0.25f);
  const F off = quarter * b + quarter * d + quarter * f + quarter * h - e;
  const F range = max(max(max(b, d), max(e, f)), h) - min(min(min(b, d), min(e, f)), h);
  const F noise = where(range > F(0.0f), min(abs(off) * medium_reciprocal<is_exact>(range), F(1.0f)));
  return F(1.0f) - F(0.5f) * noise;
}

template <bool is_exact, class F>
[[gnu::always_inline]] inline void rcas_pixels(const RcasPixels<F>& p, const RcasOptions& options, F (&out)[4]) {
  // Two limits for each channel: where subtraction of the neighbours reaches 0, and where it reaches 1.
  F lobe = F(-1.0f);
  for (int c = 0; c < 3; ++c) {
    const F least = min(min(p.above[c], p.left[c]), min(p.right[c], p.below[c]));
    const F most = max(max(p.above[c], p.left[c]), max(p.right[c], p.below[c]));
    const F low = options.limits_by_ring ? least : min(least, p.centre[c]);
    const F high = options.limits_by_ring ? most : max(most, p.centre[c]);
    // Without a limit where all neighbours are black, or all are white: they cannot push the pixel out of the range.
    const F to_black = select(most > F(0.0f), low / (F(4.0f) * most), F(1.0f));
    const F to_white =
        select((least < F(1.0f)) | (least > F(1.0f)), (F(1.0f) - high) / (F(4.0f) * least - F(4.0f)), F(-1.0f));
    lobe = max(lobe, max(-to_black, to_white));
  }
  constexpr float limit = 0.25f - 1.0f / 16;
  lobe = max(F(-limit), min(lobe, F(0.0f))) * F(options.sharpness);
  if (options.denoises) lobe = lobe * noise_factor<is_exact>(p);
  const F scale = medium_reciprocal<is_exact>(F(4.0f) * lobe + F(1.0f));
  for (int c = 0; c < 4; ++c) {
    const F sum = lobe * p.above[c] + lobe * p.left[c] + lobe * p.below[c] + lobe * p.right[c] + p.centre[c];
    out[c] = options.is_unbounded ? sum * scale : min(max(sum * scale, F(0.0f)), F(1.0f));
  }
  // Alpha stays between its neighbours, so that an opaque image stays opaque.
  const F least = min(min(p.above[3], p.left[3]), min(p.right[3], p.below[3]));
  const F most = max(max(p.above[3], p.left[3]), max(p.right[3], p.below[3]));
  out[3] = min(max(out[3], min(least, p.centre[3])), max(most, p.centre[3]));
}

template <class Full, class One, bool is_exact>
[[gnu::flatten]] void rcas_row(const float* above, const float* here, const float* below, const RcasOptions& options,
                               float* out, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    RcasPixels<F> p;
    F::load_fours(above + 4 * i, p.above), F::load_fours(below + 4 * i, p.below);
    F::load_fours(here + 4 * i, p.centre), F::load_fours(here + 4 * i - 4, p.left);
    F::load_fours(here + 4 * i + 4, p.right);
    F sharp[4];
    rcas_pixels<is_exact>(p, options, sharp);
    F::store_fours(sharp, out + 4 * i);
  });
}

template <class Full, class One>
constexpr RcasKernels rcas() {
  return {.sharpen_row = [](const float* above, const float* here, const float* below, const RcasOptions& options,
                            float* out, std::size_t n) {
    return options.reciprocals == Reciprocals::Exact ? rcas_row<Full, One, true>(above, here, below, options, out, n)
                                                     : rcas_row<Full, One, false>(above, here, below, options, out, n);
  }};
}

}  // namespace zoneplate::stages
