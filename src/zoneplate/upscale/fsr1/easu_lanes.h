// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/fsr1/easu.h"
#include "zoneplate/upscale/fsr1/reciprocal_lanes.h"
#include "zoneplate/upscale/pixel_lanes.h"

/// EasuKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

template <class F>
[[gnu::always_inline]] inline F double_luma(const F (&c)[4]) {
  return c[2] * F(0.5f) + (c[0] * F(0.5f) + c[1]);
}

template <class Full, class One>
[[gnu::flatten]] void easu_luma_row(const float* pixels, float* luma, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    F c[4];
    F::load_fours(pixels + 4 * i, c);
    double_luma(c).store(luma + i);
  });
}

/// The share of a gradient that does not reverse at the centre, squared: 1 for a monotonic one.
template <bool is_exact, class F>
[[gnu::always_inline]] inline F monotony(F before, F centre, F after) {
  const F steeper = max(abs(after - centre), abs(centre - before));
  const F ratio = min(abs(after - before) * reciprocal<is_exact>(steeper), F(1.0f));
  return where(steeper > F(0.0f), ratio * ratio);
}

template <class Full, class One, bool is_exact>
[[gnu::flatten]] void easu_edges(const float* above, const float* here, const float* below, float* edges,
                                 std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    const F a = F::load(above + i), c = F::load(here + i), e = F::load(below + i);
    const F b = F::load(here - 1 + i), d = F::load(here + 1 + i);
    const F edge[4] = {d - b, e - a, monotony<is_exact>(b, c, d) + monotony<is_exact>(a, c, e), F(0.0f)};
    F::store_fours(edge, edges + 4 * i);
  });
}

/// The filter of one output pixel: the direction of the gradient, the stretch along and across it, and the window.
template <class F>
struct EasuFilter {
  F x, y;              // direction
  F across, along;     // factors of the distance across the edge, and along it
  F lobe, window_end;  // strength of the negative lobe; the square of the distance where the window ends

  [[gnu::always_inline]] F weight(F dx, F dy) const {
    const F u = (dx * x + dy * y) * across, v = (dy * x - dx * y) * along;
    const F d2 = min(u * u + v * v, window_end);
    const F base = F(0.4f) * d2 - F(1.0f), window = lobe * d2 - F(1.0f);
    return (F(25.0f / 16) * (base * base) - F(9.0f / 16)) * (window * window);
  }
};

template <bool is_exact, class F>
[[gnu::always_inline]] inline EasuFilter<F> easu_filter(const F (&edge)[4]) {
  const F r = edge[0] * edge[0] + edge[1] * edge[1];
  const typename F::Bool is_flat = r < F(1.0f / 32768);
  const F scale = select(is_flat, F(1.0f), reciprocal_root<is_exact>(r));
  EasuFilter<F> f;
  f.x = select(is_flat, F(1.0f), edge[0]) * scale, f.y = edge[1] * scale;
  const F half = edge[2] * F(0.5f), length = half * half;
  const F stretch = (f.x * f.x + f.y * f.y) * reciprocal<is_exact>(max(abs(f.x), abs(f.y)));
  f.across = F(1.0f) + (stretch - F(1.0f)) * length;
  f.along = F(1.0f) - F(0.5f) * length;
  f.lobe = F(0.5f) + F(0.25f - 0.04f - 0.5f) * length;
  f.window_end = reciprocal<is_exact>(f.lobe);
  return f;
}

template <class Full, class One, bool is_exact>
[[gnu::flatten]] void easu_upscale(const EasuRow& row, float* out, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    const F x = F::load(row.right + i), y = F(row.below), far_x = F(1.0f) - x, far_y = F(1.0f) - y;
    const F bilinear[4] = {far_x * far_y, x * far_y, far_x * y, x * y};
    F edge[4] = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
    for (std::size_t corner = 0; corner < 4; ++corner) {
      F own[4];
      load_pixels<F>(
          [&](int lane) {
            return row.edges[corner / 2] + row.edge[i + static_cast<std::size_t>(lane)] + corner % 2 * 4;
          },
          own);
      for (std::size_t c = 0; c < 3; ++c) edge[c] = edge[c] + own[c] * bilinear[corner];
    }
    const EasuFilter<F> filter = easu_filter<is_exact>(edge);

    F sum[4] = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)}, weights = F(0.0f), least[4], most[4];
    for (int tap_y = 0; tap_y < 4; ++tap_y) {
      for (int tap_x = 0; tap_x < 4; ++tap_x) {
        const bool is_inner = (tap_x == 1 || tap_x == 2) && (tap_y == 1 || tap_y == 2);
        if ((tap_x == 0 || tap_x == 3) && (tap_y == 0 || tap_y == 3)) continue;
        F c[4];
        load_pixels<F>(
            [&](int lane) { return row.rows[tap_y] + row.columns[tap_x][i + static_cast<std::size_t>(lane)]; }, c);
        const F w = filter.weight(F(static_cast<float>(tap_x - 1)) - x, F(static_cast<float>(tap_y - 1)) - y);
        weights = weights + w;
        for (int k = 0; k < 4; ++k) {
          sum[k] = sum[k] + c[k] * w;
          if (!is_inner) continue;
          const bool is_first = tap_x == 1 && tap_y == 1;
          least[k] = is_first ? c[k] : min(least[k], c[k]), most[k] = is_first ? c[k] : max(most[k], c[k]);
        }
      }
    }
    const F scale = F(1.0f) / weights;
    for (int k = 0; k < 4; ++k) sum[k] = min(most[k], max(least[k], sum[k] * scale));
    F::store_fours(sum, out + 4 * i);
  });
}

template <class Full, class One>
constexpr EasuKernels easu() {
  return {.luma_row = &easu_luma_row<Full, One>,
          .edge_row =
              [](const float* above, const float* here, const float* below, Reciprocals reciprocals, float* edges,
                 std::size_t n) {
                return reciprocals == Reciprocals::Exact ? easu_edges<Full, One, true>(above, here, below, edges, n)
                                                         : easu_edges<Full, One, false>(above, here, below, edges, n);
              },
          .upscale_row =
              [](const EasuRow& row, Reciprocals reciprocals, float* out, std::size_t n) {
                return reciprocals == Reciprocals::Exact ? easu_upscale<Full, One, true>(row, out, n)
                                                         : easu_upscale<Full, One, false>(row, out, n);
              }};
}

}  // namespace zoneplate::stages
