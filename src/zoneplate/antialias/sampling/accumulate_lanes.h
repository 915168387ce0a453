// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/sampling/accumulate.h"

/// The kernels of antialias/sampling/accumulate.h over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// The greatest of red, green and blue, at least 0.
template <class F>
[[gnu::always_inline]] inline F max_channel(const F (&c)[4]) {
  return max(max(c[0], c[1]), max(c[2], F(0.0f)));
}

template <class F>
[[gnu::always_inline]] inline void scale_color(F (&c)[4], F by) {
  for (int k = 0; k < 3; ++k) c[k] = c[k] * by;
}

/// Calls change(pixels, i) in place for whole vectors of n pixels of four floats.
template <class F, class Change>
[[gnu::always_inline]] inline void change_pixels(float* color, std::size_t n, const Change& change) {
  for (std::size_t i = 0; i < n; i += F::lanes) {
    F c[4];
    F::load_fours(color + 4 * i, c);
    change(c, i);
    F::store_fours(c, color + 4 * i);
  }
}

template <class F>
[[gnu::flatten]] void weigh_karis(float exposure, float* color, float* weight, std::size_t n) {
  constexpr const float(&luma_weight)[3] = AccumulateKernels::luma;
  change_pixels<F>(color, n, [=](F(&c)[4], std::size_t i) {
    const F luma = F(luma_weight[0]) * c[0] + F(luma_weight[1]) * c[1] + F(luma_weight[2]) * c[2];
    const F w = F(1.0f) / (F(1.0f) + max(luma, F(0.0f)) * F(exposure));
    scale_color(c, w);
    c[3] = c[3] * w;
    w.store(weight + i);
  });
}

template <class F>
[[gnu::flatten]] void map_max3(float* color, std::size_t n) {
  change_pixels<F>(color, n, [](F(&c)[4], std::size_t) { scale_color(c, F(1.0f) / (F(1.0f) + max_channel(c))); });
}

template <class F>
[[gnu::flatten]] void premultiply(float* color, std::size_t n) {
  change_pixels<F>(color, n, [](F(&c)[4], std::size_t) { scale_color(c, c[3]); });
}

template <class F>
[[gnu::flatten]] void spread(const float* in, std::size_t step, const float* across, int taps, const float* down,
                             float* const* rows, int row_count, std::size_t n) {
  for (std::size_t i = 0; i < n; i += F::lanes) {
    F sum = F(across[0]) * F::load(in + i);
    for (int d = 1; d < taps; ++d) sum = sum + F(across[d]) * F::load(in + i + static_cast<std::size_t>(d) * step);
    for (int k = 0; k < row_count; ++k) (F::load(rows[k] + i) + F(down[k]) * sum).store(rows[k] + i);
  }
}

template <class F, bool is_max3>
[[gnu::always_inline]] inline void mean_row(const float* color, const float* weight, float* out, std::size_t n) {
  const auto mean_at = [=](std::size_t i, float* to) {
    F c[4];
    F::load_fours(color + 4 * i, c);
    const F w = F::load(weight + i);
    c[0] = c[0] / w, c[1] = c[1] / w, c[2] = c[2] / w, c[3] = c[3] / w;
    const F limit(AccumulateKernels::max_mapped);
    if constexpr (is_max3) scale_color(c, F(1.0f) / (F(1.0f) - min(max_channel(c), limit)));
    F::store_fours(c, to);
  };
  std::size_t i = 0;
  for (; i + F::lanes <= n; i += F::lanes) mean_at(i, out + 4 * i);
  if (i == n) return;
  float rest[4 * F::lanes];
  mean_at(i, rest);
  for (std::size_t k = 0; k < 4 * (n - i); ++k) out[4 * i + k] = rest[k];
}

template <class F>
[[gnu::flatten]] void mean(const float* color, const float* weight, bool is_max3, float* out, std::size_t n) {
  is_max3 ? mean_row<F, true>(color, weight, out, n) : mean_row<F, false>(color, weight, out, n);
}

template <class F>
constexpr AccumulateKernels accumulate() {
  return {.weigh_karis = &weigh_karis<F>,
          .map_max3 = &map_max3<F>,
          .premultiply = &premultiply<F>,
          .spread = &spread<F>,
          .mean = &mean<F>};
}

}  // namespace zoneplate::stages
