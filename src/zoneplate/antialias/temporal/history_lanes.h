// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/antialias/temporal/reprojection_lanes.h"

/// The colour of the history between pixels, over a lane type of math/lanes.h.
///
/// Sums are of differences from the texel at the source's own pixel: a history of one colour gives that colour exactly.
namespace zoneplate::stages {

/// The colours of a history at the pixels i and following of a row.
template <class F>
[[gnu::always_inline]] inline Rgba<F> colors_at(const ColorPlanes<const float>& history, const TemporalRow& row,
                                                std::ptrdiff_t i) {
  return Rgba<F>::load(history, row.y * history.stride() + i);
}
template <class F>
[[gnu::always_inline]] inline Rgba<F> colors_at(const float* history, const TemporalRow& row, std::ptrdiff_t i) {
  return Rgba<F>::load(history + 4 * (std::ptrdiff_t{row.y} * row.width + i));
}

template <class F, class ColorAt>
[[gnu::always_inline]] inline Rgba<F> bilinear_history(const Source<F>& source, const ColorAt& color) {
  const F one(1.0f);
  const F x = source.fraction[0], y = source.fraction[1];
  const Rgba<F> base = color(0, 0);
  const Rgba<F> right = color(1, 0) - base, below = color(0, 1) - base;
  const Rgba<F> across = color(1, 1) - base;
  return base + ((right * (x * (one - y)) + below * ((one - x) * y)) + across * (x * y));
}

/// The weights of the pixels -1, 0, 1 and 2 at a fraction of the distance from 0 to 1.
///
/// Source    Catmull and Rom, A Class of Local Interpolating Splines, 1974.
template <class F>
[[gnu::always_inline]] inline void catmull_rom(F f, F (&w)[4]) {
  const F half(0.5f);
  w[0] = f * (f * (F(1.0f) - half * f) - half);
  w[1] = F(1.0f) + f * f * (F(1.5f) * f - F(2.5f));
  w[2] = f * (half + f * (F(2.0f) - F(1.5f) * f));
  w[3] = f * f * (half * f - half);
}

template <class F, class ColorAt>
[[gnu::always_inline]] inline Rgba<F> catmull_rom_history(const Source<F>& source, const ColorAt& color,
                                                          bool has_corners, bool is_normalized) {
  F wx[4], wy[4];
  catmull_rom(source.fraction[0], wx), catmull_rom(source.fraction[1], wy);
  const Rgba<F> base = color(0, 0);
  Rgba<F> sum = Rgba<F>::all(F(0.0f));
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const bool is_corner = (i == 0 || i == 3) && (j == 0 || j == 3);
      if ((i == 1 && j == 1) || (is_corner && !has_corners)) continue;
      sum = sum + (color(i - 1, j - 1) - base) * (wx[i] * wy[j]);
    }
  if (has_corners) return base + sum;
  const F total = F(1.0f) - (wx[0] + wx[3]) * (wy[0] + wy[3]);
  return is_normalized ? base + sum * (F(1.0f) / total) : base * total + sum;
}

/// The history at the source; not negative, and at most 1 if it is compressed. `history` are planes, or four floats a
/// pixel.
template <class F, class Colors>
[[gnu::always_inline]] inline Rgba<F> history_of(const Colors& history, const TemporalRow& row,
                                                 const TemporalParts& parts, const Source<F>& source,
                                                 std::ptrdiff_t i) {
  using Filter = TemporalParts::Filter;
  if (source.is_at_rest()) return colors_at<F>(history, row, i);
  const PastPixels<F> past = pixels_around(row, source, i);
  return past.with_colors(history, [&](const auto& color) {
    if (parts.filter == Filter::Bilinear) return bilinear_history(source, color);
    const Rgba<F> sharp = catmull_rom_history(source, color, parts.filter == Filter::CatmullRom9, parts.is_normalized);
    const F most(parts.is_compressed ? 1.0f : 65504.0f);
    return min(max(sharp, Rgba<F>::all(F(0.0f))), Rgba<F>::all(most));
  });
}

}  // namespace zoneplate::stages
