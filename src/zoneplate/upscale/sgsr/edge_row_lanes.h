// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/for_row.h"
#include "zoneplate/upscale/pixel_lanes.h"
#include "zoneplate/upscale/sgsr/edge_row.h"

/// SgsrKernels over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// The weights of the taps: of a tap's offset and its value, from which the mean is subtracted.
template <class F>
struct SgsrFilter {
  F contrast;  // the square of the inverse of the mean deviation
  F x, y;      // direction of the gradient

  [[gnu::always_inline]] F weight(F dx, F dy, F value) const {
    const F off = dx * y + dy * x, share = min(value * value * contrast, F(1.0f));
    const F place = dx * dx + dy * dy + off * off * (share * F(0.7f) - F(1.0f));
    const F outer = place - F(4.0f);
    return (place * outer - outer) * (outer * outer);
  }
};

template <class F>
[[gnu::always_inline]] inline F sgsr_change(const SgsrRow& row, std::size_t i, F x, F y, F centre) {
  using Int = typename F::Int;
  constexpr int green = 1;
  // b c, e f g h, i j k l, n o: without the corners.
  F taps[4][4];
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      if ((r != 0 && r != 3) || (c != 0 && c != 3))
        taps[r][c] = F::gather(row.rows[r] + green, Int::load(row.columns[c] + i));
  const F mean = (taps[2][1] + taps[1][1] + taps[2][2] + taps[1][2]) * F(0.25f);
  F deviation = F(0.0f);
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      if ((r != 0 && r != 3) || (c != 0 && c != 3)) {
        taps[r][c] = taps[r][c] - mean;
        deviation = deviation + abs(taps[r][c]);
      }
  const F inverse = F(10.14185f) / deviation;
  const F falling = taps[2][2] - taps[1][1], rising = taps[1][2] - taps[2][1];
  const F dx = falling + rising, dy = falling - rising;
  const F scale = F(1.0f) / sqrt(dx * dx + F(3.07574e-5f) + dy * dy);
  const SgsrFilter<F> filter{inverse * inverse, dx * scale, dy * scale};
  F sum = F(0.0f), weights = F(0.0f);
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      if ((r != 0 && r != 3) || (c != 0 && c != 3)) {
        const F w = filter.weight(x - F(static_cast<float>(c - 1)), y - F(static_cast<float>(r - 1)), taps[r][c]);
        weights = weights + w, sum = sum + w * taps[r][c];
      }
  const F least = min(min(taps[1][1], taps[2][1]), min(taps[1][2], taps[2][2]));
  const F most = max(max(taps[1][1], taps[2][1]), max(taps[1][2], taps[2][2]));
  constexpr float sharpness = 2, limit = 23.0f / 255;
  const F sharp = min(max(F(sharpness) * (sum / weights), least), most);
  return min(max(sharp - (centre - mean), F(-limit)), F(limit));
}

template <class Full, class One>
[[gnu::flatten]] void sgsr_row(const SgsrRow& row, float* out, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t i) {
    const F x = F::load(row.right + i), y = F(row.below);
    F corners[4][4], c[4];
    for (std::size_t corner = 0; corner < 4; ++corner)
      load_pixels<F>(
          [&](int lane) {
            return row.rows[1 + corner / 2] + row.columns[1 + corner % 2][i + static_cast<std::size_t>(lane)];
          },
          corners[corner]);
    for (int k = 0; k < 4; ++k) {
      const F above = corners[0][k] + (corners[1][k] - corners[0][k]) * x;
      const F below = corners[2][k] + (corners[3][k] - corners[2][k]) * x;
      c[k] = above + (below - above) * y;
    }
    // Of the four nearest pixels, only the left two decide about an edge, as in the source.
    const F f = corners[0][1], j = corners[2][1];
    const auto is_edge = abs(f - j) + abs(c[1] - j) + abs(c[1] - f) > F(8.0f / 255);
    if (!none(is_edge)) {
      const F change = where(is_edge, sgsr_change<F>(row, i, x, y, c[1]));
      for (int k = 0; k < 3; ++k) c[k] = min(max(c[k] + change, F(0.0f)), F(1.0f));
    }
    F::store_fours(c, out + 4 * i);
  });
}

template <class Full, class One>
constexpr SgsrKernels sgsr() {
  return {.upscale_row = &sgsr_row<Full, One>};
}

}  // namespace zoneplate::stages
