// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/antialias/temporal/color_lanes.h"
#include "zoneplate/math/for_row.h"

/// The range in which temporal antialiasing averages colours, over a lane type of math/lanes.h.
///
/// The straight colour is compressed and multiplied by alpha, and alpha itself is averaged as it is: the mean of an
/// opaque and a transparent sample decodes to the opaque colour with half the alpha, without a dark fringe.
namespace zoneplate::stages {

/// Source    three.js and Bevy: negative, infinite and undefined colours do not enter the history.
template <class F>
[[gnu::always_inline]] inline Rgba<F> finite_color(const float* p) {
  // min and max return their second argument if the first is NaN.
  return min(max(Rgba<F>::load(p), Rgba<F>::all(F(0.0f))), Rgba<F>::all(F(65504.0f)));
}

/// Alpha as a divisor.
template <class F>
[[gnu::always_inline]] inline F divisor_of(const Rgba<F>& c) {
  return max(c.c[3], F(0x1p-10f));
}

template <class F>
[[gnu::always_inline]] inline Rgba<F> scaled(const Rgba<F>& c, F factor) {
  return {{c.c[0] * factor, c.c[1] * factor, c.c[2] * factor, c.c[3]}};
}

/// The colour of four floats by which temporal antialiasing averages.
template <class F>
[[gnu::always_inline]] inline Rgba<F> encoded_color(const float* linear, bool is_compressed) {
  const Rgba<F> c = finite_color<F>(linear);
  if (!is_compressed) return c;
  const F alpha = divisor_of(c);
  return scaled(c, alpha / (alpha + max3(c)));
}

template <class Full, class One>
[[gnu::flatten]] void limit_colors(const float* linear, float* limited, std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) { finite_color<F>(linear + 4 * i).store(limited + 4 * i); });
}

template <class Full, class One>
[[gnu::flatten]] void encode_temporal(const float* linear, bool is_compressed, const ColorPlanes<float>& encoded,
                                      std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    encoded_color<F>(linear + 4 * i, is_compressed).store(encoded, i);
  });
}

template <class Full, class One>
[[gnu::flatten]] void decode_temporal(const ColorPlanes<const float>& resolved, const ColorPlanes<const float>& encoded,
                                      const float* linear, bool is_compressed, float* out, std::size_t n) {
  for_row<Full, One>(n, [&]<class F>(std::size_t at) {
    const auto i = static_cast<std::ptrdiff_t>(at);
    Rgba<F> c = Rgba<F>::load(resolved, i);
    if (is_compressed) {
      const F alpha = divisor_of(c);
      const Rgba<F> decoded = scaled(c, alpha / max(alpha - max3(c), alpha * F(0x1p-16f)));
      c = select(c == Rgba<F>::load(encoded, i), finite_color<F>(linear + 4 * i), decoded);
    }
    c.store(out + 4 * i);
  });
}

template <class Full, class One>
[[gnu::flatten]] void sharpen_temporal(const float* color, std::ptrdiff_t stride, float strength, float* out,
                                       std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) {
    using Color = Rgba<F>;
    const float* const here = color + 4 * i;
    const Color c = Color::load(here), left = Color::load(here - 4), right = Color::load(here + 4);
    const Color above = Color::load(here - stride), below = Color::load(here + stride);
    const Color least = min(min(min(left, right), min(above, below)), c);
    const Color most = max(max(max(left, right), max(above, below)), c);
    const Color detail = ((c - left) + (c - right)) + ((c - above) + (c - below));
    max(min(c + detail * F(strength * 0.25f), most), least).store(out + 4 * i);
  });
}

}  // namespace zoneplate::stages
