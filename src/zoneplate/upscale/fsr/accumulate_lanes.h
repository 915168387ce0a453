// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/math/blend_lanes.h"
#include "zoneplate/upscale/pixel_lanes.h"

/// What the accumulation of FSR 2 and that of FSR 3 have in common, over a lane type of math/lanes.h.
namespace zoneplate::stages::fsr {

template <class F>
[[gnu::always_inline]] inline F smaller_over_greater(F a, F b) {
  const F greater = max(a, b);
  return select(greater == F(0.0f), F(0.0f), min(a, b) / greater);
}

template <class F>
struct Color {
  F c[3];
};
template <class F>
[[gnu::always_inline]] inline Color<F> rgb_of(const Color<F>& y) {
  return {{y.c[0] + y.c[1] - y.c[2], y.c[0] + y.c[2], y.c[0] - y.c[1] - y.c[2]}};
}
template <class F>
[[gnu::always_inline]] inline Color<F> ycocg_of(const Color<F>& c) {
  return {{F(0.25f) * c.c[0] + F(0.5f) * c.c[1] + F(0.25f) * c.c[2], F(0.5f) * c.c[0] - F(0.5f) * c.c[2],
           F(-0.25f) * c.c[0] + F(0.5f) * c.c[1] - F(0.25f) * c.c[2]}};
}
template <class F>
[[gnu::always_inline]] inline Color<F> scaled(const Color<F>& c, F s) {
  return {{c.c[0] * s, c.c[1] * s, c.c[2] * s}};
}
template <class F>
[[gnu::always_inline]] inline Color<F> tone_mapped(const Color<F>& c) {
  return scaled(c, F(1.0f) / (max(max(F(0.0f), c.c[0]), max(c.c[1], c.c[2])) + F(1.0f)));
}
/// The inverse, for a greatest channel of at most 1 - `least`.
template <class F>
[[gnu::always_inline]] inline Color<F> inverse_tone_mapped(const Color<F>& c, float least) {
  return scaled(c, F(1.0f) / max(F(least), F(1.0f) - max(c.c[0], max(c.c[1], c.c[2]))));
}

/// The weights of four samples at -1, 0, 1 and 2, of Lanczos' kernel with two lobes at t in [0, 1), with the sum 1.
/// Samples nearer than `epsilon` have the greatest weight.
template <class F>
[[gnu::always_inline]] inline void lanczos_weights(F t, float epsilon, F (&w)[4]) {
  constexpr float half_pi = 1.57079632679f;
  const F s = sin(t * F(half_pi)), c = cos(t * F(half_pi)), sc2 = F(2.0f) * s * c;
  // sin(πx) sin(πx/2) / (½ π² x²): up to the sign, the sines of all four are those of t.
  const auto over_square = [epsilon](F sines, F x) {
    const F value = sines / (F(2 * half_pi * half_pi) * (x * x));
    return select(F(epsilon) > abs(x), F(1.0f), value);
  };
  w[0] = over_square(-sc2 * c, F(1.0f) + t), w[1] = over_square(sc2 * s, t);
  w[2] = over_square(sc2 * c, F(1.0f) - t), w[3] = over_square(-sc2 * s, F(2.0f) - t);
  const F scale = F(1.0f) / (w[0] + w[1] + w[2] + w[3]);
  for (F& each : w) each = each * scale;
}

/// The approximation of the kernel of the square of a distance, at most 4.
template <class F>
[[gnu::always_inline]] inline F lanczos_of_square(F x2) {
  x2 = min(x2, F(4.0f));
  const F a = F(0.4f) * x2 - F(1.0f), b = F(0.25f) * x2 - F(1.0f);
  return (F(25.0f / 16) * a * a - F(25.0f / 16 - 1)) * (b * b);
}

template <class F>
[[gnu::always_inline]] inline F bilinear(const float* const (&rows)[2], typename F::Int left, typename F::Int right,
                                         F x, F y) {
  const F above = mixed(F::gather(rows[0], left), F::gather(rows[0], right), x);
  return mixed(above, mixed(F::gather(rows[1], left), F::gather(rows[1], right), x), y);
}

/// Pixels around a place of an image: their indices, clamped to the image without its margin, and the place between
/// them.
template <class F, int taps>
struct Neighbours {
  using Int = typename F::Int;
  Int column[taps], row[taps];  // row: the index of its first pixel
  F right, below;

  /// The first tap is `before` pixels before the pixel at or before (x, y), which are in pixels from the first centre.
  [[gnu::always_inline]] Neighbours(int width, int height, F x, F y, int before, int margin = 0) {
    const F left = floor(x), top = floor(y);
    right = x - left, below = y - top;
    const auto clamped = [margin](Int i, int size) {
      const int first = margin < size ? margin : size - 1, last = size - 1 - margin;
      return min(max(i, Int(first)), Int(last > first ? last : first));
    };
    for (int t = 0; t < taps; ++t) {
      column[t] = clamped(truncate(left) + Int(t - before), width);
      row[t] = clamped(truncate(top) + Int(t - before), height) * Int(width);
    }
  }
  [[gnu::always_inline]] void load(const float* pixels, int c, int r, F (&out)[4]) const {
    std::int32_t index[F::lanes];
    (row[r] + column[c]).store(index);
    load_pixels<F>([&](int lane) { return pixels + std::size_t{4} * static_cast<std::size_t>(index[lane]); }, out);
  }
};

/// The four channels of an image at a place, by Lanczos' kernel, within the range of the four nearest pixels.
template <class F>
[[gnu::always_inline]] inline void sample_by_lanczos(const float* image, const Neighbours<F, 4>& taps, float epsilon,
                                                     F (&out)[4]) {
  F wx[4], wy[4], least[4], most[4];
  lanczos_weights(taps.right, epsilon, wx), lanczos_weights(taps.below, epsilon, wy);
  for (int c = 0; c < 4; ++c) out[c] = F(0.0f);
  for (int r = 0; r < 4; ++r) {
    F sum[4] = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)};
    for (int k = 0; k < 4; ++k) {
      F pixel[4];
      taps.load(image, k, r, pixel);
      for (int c = 0; c < 4; ++c) sum[c] = sum[c] + wx[k] * pixel[c];
      if ((k != 1 && k != 2) || (r != 1 && r != 2)) continue;
      for (int c = 0; c < 4; ++c) {
        const bool is_first = k == 1 && r == 1;
        least[c] = is_first ? pixel[c] : min(least[c], pixel[c]),
        most[c] = is_first ? pixel[c] : max(most[c], pixel[c]);
      }
    }
    for (int c = 0; c < 4; ++c) out[c] = out[c] + wy[r] * sum[c];
  }
  for (int c = 0; c < 4; ++c) out[c] = min(max(out[c], least[c]), most[c]);
}

/// True for positions in the image, whose width and height are 1.
template <class F>
[[gnu::always_inline]] inline typename F::Bool is_in_image(F x, F y) {
  const F zero = F(0.0f), one = F(1.0f);
  return (x >= zero) & (one >= x) & (y >= zero) & (one >= y);
}

}  // namespace zoneplate::stages::fsr
