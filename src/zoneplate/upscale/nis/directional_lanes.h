// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/blend_lanes.h"
#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/nis/directional.h"
#include "zoneplate/upscale/pixel_lanes.h"

/// NisKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

template <class F>
[[gnu::always_inline]] inline F nis_luma(const F (&c)[4]) {
  return F(0.2126f) * c[0] + F(0.7152f) * c[1] + F(0.0722f) * c[2];
}

template <class Full, class One>
[[gnu::flatten]] void nis_luma_row(const float* pixels, float* luma, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    F c[4];
    F::load_fours(pixels + 4 * i, c);
    nis_luma(c).store(luma + i);
  });
}

template <class Full, class One>
[[gnu::flatten]] void nis_edge_row(const float* above, const float* here, const float* below,
                                   const NisConstants& constants, float* edges, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    const float* const rows[3] = {above + i, here + i, below + i};
    F p[3][3];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) p[r][c] = F::load(rows[r] + c - 1);
    const F level = abs(p[0][0] + p[0][1] + p[0][2] - p[2][0] - p[2][1] - p[2][2]);
    const F rising = abs(p[1][0] + p[0][0] + p[0][1] - p[2][1] - p[2][2] - p[1][2]);
    const F upright = abs(p[0][0] + p[1][0] + p[2][0] - p[0][2] - p[1][2] - p[2][2]);
    const F falling = abs(p[1][0] + p[2][0] + p[2][1] - p[0][1] - p[0][2] - p[1][2]);

    const F straight = max(level, upright), straight_low = min(level, upright);
    const F slanted = max(rising, falling), slanted_low = min(rising, falling);
    const F sum = straight + slanted;
    const F straight_share = min(straight / sum, F(1.0f)), slanted_share = F(1.0f) - straight_share;
    const auto is_edge = [&](F high, F low, F other_low) {
      return (high > low * F(constants.detect_ratio)) & (high > F(constants.detect_threshold)) & (high > other_low);
    };
    const auto is_any = sum > F(0.0f);
    const auto is_straight = is_any & is_edge(straight, straight_low, slanted_low);
    const auto is_slanted = is_any & is_edge(slanted, slanted_low, straight_low);
    const auto is_both = is_straight & is_slanted;
    const F straight_weight = where(is_straight, select(is_both, straight_share, F(1.0f)));
    const F slanted_weight = where(is_slanted, select(is_both, slanted_share, F(1.0f)));
    const auto is_level = straight == level, is_rising = slanted == rising;
    const F weights[4] = {where(is_level, straight_weight), select(is_level, F(0.0f), straight_weight),
                          where(is_rising, slanted_weight), select(is_rising, F(0.0f), slanted_weight)};
    F::store_fours(weights, edges + 4 * i);
  });
}

template <class Full, class One>
[[gnu::flatten]] void nis_column_row(const float* const* rows, const float* taps, float* out, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    F sum = F::load(rows[0] + i) * F(taps[0]);
    for (int t = 1; t < 6; ++t) sum = sum + F::load(rows[t] + i) * F(taps[t]);
    sum.store(out + i);
  });
}

/// 1 where the contrasts of both sides of a filter are alike, 0 where one is much greater: there sharpening would ring.
template <class F>
[[gnu::always_inline]] inline F contrast_factor(F a, F b, F c, F d, F e, F f, const NisConstants& constants) {
  const F first = max(max(b, c), a) - min(min(b, c), a), second = max(max(d, e), f) - min(min(d, e), f);
  const F ratio = max(first, second) / (min(first, second) + F(1.0f / 255));
  return F(1.0f) - saturated((ratio - F(constants.min_contrast)) * F(constants.contrast_scale));
}

/// A detail that sharpening adds, scaled and limited by the luma on which it lies.
template <class F>
[[gnu::always_inline]] inline F limited_detail(F detail, F luma, const NisConstants& constants) {
  const F ramp = F(1.0f) - saturated((luma - F(constants.first_luma)) * F(constants.luma_scale));
  const F limit = (ramp * F(constants.limit_scale) + F(constants.limit)) * luma;
  return min(limit, max(-limit, detail * (ramp * F(constants.strength_scale) + F(constants.strength))));
}

/// Six lumas along a direction, interpolated at a phase and sharpened.
template <class F>
[[gnu::always_inline]] inline F along_direction(const F (&v)[6], typename F::Int phase, const NisTaps& taps,
                                                const NisConstants& constants) {
  using Int = typename F::Int;
  F luma = F(0.0f), detail = F(0.0f);
  for (int t = 0; t < 6; ++t) {
    luma = luma + F::gather(taps.scale + t, phase * Int(8)) * v[t];
    detail = detail + F::gather(taps.sharpening + t, phase * Int(8)) * v[t];
  }
  const auto is_early = phase < Int(nis_phases / 2 + 1);
  const F factor =
      contrast_factor(select(is_early, v[0], v[3]), v[1], v[2], v[3], v[4], select(is_early, v[2], v[5]), constants);
  return luma + limited_detail(detail, luma, constants) * factor;
}

/// The six lumas along a diagonal, of lumas p[along][across] that are turned so that the diagonal descends to the
/// right: (0, 0), (1, 1), ... `across` is the distance from it in [0, 1], ½ on it; `beyond` that along it, in [0, 2).
template <class F, class At>
[[gnu::always_inline]] inline F along_diagonal(const At& at, F across, F beyond, const NisTaps& taps,
                                               const NisConstants& constants) {
  const F away = across - F(0.5f), size = abs(away);
  const auto is_right = away >= F(0.0f);
  F line[7];
  for (int k = 0; k < 3; ++k) line[2 * k + 1] = mixed(at(k + 2, k + 1), at(k + 1, k + 2), across);
  for (int k = 0; k < 4; ++k) line[2 * k] = mixed(at(k + 1, k + 1), select(is_right, at(k, k + 2), at(k + 2, k)), size);
  const auto is_second = beyond >= F(1.0f);
  F v[6];
  for (int t = 0; t < 6; ++t) v[t] = select(is_second, line[t + 1], line[t]);
  const F rest = select(is_second, beyond - F(1.0f), beyond);
  using Int = typename F::Int;
  return along_direction(v, min(truncate(rest * F(static_cast<float>(nis_phases))), Int(nis_phases - 1)), taps,
                         constants);
}

template <class Full, class One>
[[gnu::flatten]] void nis_scale_row(const NisRow& row, const NisTaps& taps, const NisConstants& constants, float* out,
                                    std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    using Int = typename F::Int;
    const F x = F::load(row.right + i), y = F(row.below);
    const Int first = Int::load(row.luma + i), phase_x = Int::load(row.right_phase + i);

    F weights[4];
    {
      F e[4][4];
      for (std::size_t corner = 0; corner < 4; ++corner)
        load_pixels<F>(
            [&](int lane) {
              return row.edges[corner / 2] + row.edge[i + static_cast<std::size_t>(lane)] + corner % 2 * 4;
            },
            e[corner]);
      for (int c = 0; c < 4; ++c) weights[c] = mixed(mixed(e[0][c], e[1][c], x), mixed(e[2][c], e[3][c], x), y);
    }

    F luma = F(0.0f);
    for (int t = 0; t < 6; ++t)
      luma = luma + F::gather(row.columns + t, first) * F::gather(taps.scale + t, phase_x * Int(8));
    luma = luma * (F(1.0f) - weights[0] - weights[1] - weights[2] - weights[3]);
    const auto has = [&](int direction) { return !none(weights[direction] > F(0.0f)); };
    if (has(0) || has(1) || has(2) || has(3)) {
      F p[6][6];
      for (int r = 0; r < 6; ++r)
        for (int c = 0; c < 6; ++c) p[r][c] = F::gather(row.lumas[r] + c, first);
      F v[6], directional = F(0.0f);
      if (has(0)) {
        for (int t = 0; t < 6; ++t) v[t] = mixed(p[t][2], p[t][3], x);
        directional = directional + along_direction(v, Int(row.below_phase), taps, constants) * weights[0];
      }
      if (has(1)) {
        for (int t = 0; t < 6; ++t) v[t] = mixed(p[2][t], p[3][t], y);
        directional = directional + along_direction(v, phase_x, taps, constants) * weights[1];
      }
      if (has(2)) {
        const auto at = [&](int r, int c) { return p[r][c]; };
        directional =
            directional + along_diagonal<F>(at, F(0.5f) + F(0.5f) * (x - y), x + y, taps, constants) * weights[2];
      }
      if (has(3)) {
        const auto at = [&](int r, int c) { return p[5 - r][c]; };
        directional =
            directional + along_diagonal<F>(at, F(0.5f) * (x + y), F(1.0f) + (x - y), taps, constants) * weights[3];
      }
      luma = luma + directional;
    }

    F colors[4][4], c[4];
    for (std::size_t corner = 0; corner < 4; ++corner)
      load_pixels<F>(
          [&](int lane) { return row.pixels[corner / 2] + row.pixel[corner % 2][i + static_cast<std::size_t>(lane)]; },
          colors[corner]);
    for (int k = 0; k < 4; ++k)
      c[k] = mixed(mixed(colors[0][k], colors[1][k], x), mixed(colors[2][k], colors[3][k], x), y);
    const F correction = luma - nis_luma(c);
    for (int k = 0; k < 3; ++k) c[k] = saturated(c[k] + correction);
    F::store_fours(c, out + 4 * i);
  });
}

/// The second difference across an edge of five lumas, as a detail without overshoot.
template <class F>
[[gnu::always_inline]] inline F detail_of(F a, F b, F c, F d, F e, F centre, const NisConstants& constants) {
  const F detail = F(-0.6001f) * b + F(1.2002f) * c - F(0.6001f) * d;
  return limited_detail(detail, centre, constants) * contrast_factor(a, b, c, c, d, e, constants);
}

template <class Full, class One>
[[gnu::flatten]] void nis_sharpen_row(const float* const* lumas, const float* edges, const float* pixels,
                                      const NisConstants& constants, float* out, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    const auto at = [&](int r, int c) { return F::load(lumas[r + 2] + i + c); };
    const F centre = at(0, 0), half = F(0.5f);
    F w[4], c[4];
    F::load_fours(edges + 4 * i, w), F::load_fours(pixels + 4 * i, c);
    const F level = detail_of(at(-2, 0), at(-1, 0), centre, at(1, 0), at(2, 0), centre, constants);
    const F upright = detail_of(at(0, -2), at(0, -1), centre, at(0, 1), at(0, 2), centre, constants);
    const F rising = detail_of(at(-1, -1), mixed(at(0, -1), at(-1, 0), half), centre, mixed(at(1, 0), at(0, 1), half),
                               at(1, 1), centre, constants);
    const F falling = detail_of(at(1, -1), mixed(at(1, 0), at(0, -1), half), centre, mixed(at(0, 1), at(-1, 0), half),
                                at(-1, 1), centre, constants);
    const F change = level * w[0] + upright * w[1] + rising * w[2] + falling * w[3];
    for (int k = 0; k < 3; ++k) c[k] = saturated(c[k] + change);
    F::store_fours(c, out + 4 * i);
  });
}

template <class Full, class One>
constexpr NisKernels nis() {
  return {.luma_row = &nis_luma_row<Full, One>,
          .edge_row = &nis_edge_row<Full, One>,
          .column_row = &nis_column_row<Full, One>,
          .scale_row = &nis_scale_row<Full, One>,
          .sharpen_row = &nis_sharpen_row<Full, One>};
}

}  // namespace zoneplate::stages
