// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/math/lanes_vector.h"

/// Perlin's gradient noise and its fractal sums, as templates over the lane types of math/lanes.h.
namespace zoneplate {

/// The constants of the reference implementation of improved noise.
///
/// Source    Perlin, Improving Noise, SIGGRAPH 2002: the permutation of 0 to 255 (repeated, so that two table look-ups
///           need no wrap between them) and the 12 gradients, four of them twice.
struct NoiseTables {
  std::int32_t permutation[512];
  static constexpr std::int32_t gradient[3][16] = {{1, -1, 1, -1, 1, -1, 1, -1, 0, 0, 0, 0, 1, 0, -1, 0},
                                                   {1, 1, -1, -1, 0, 0, 0, 0, 1, -1, 1, -1, 1, -1, 1, -1},
                                                   {0, 0, 0, 0, 1, 1, -1, -1, 1, 1, -1, -1, 0, 1, 0, -1}};
};

constexpr NoiseTables make_noise_tables() {
  constexpr std::uint8_t once[256] = {
      151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
      8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
      117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
      71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
      55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
      18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
      124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
      28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
      129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
      242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
      181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
      67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};
  NoiseTables tables{};
  for (int i = 0; i < 512; ++i) tables.permutation[i] = once[i % 256];
  return tables;
}

inline constexpr NoiseTables noise_tables = make_noise_tables();

/// A function of space at a point: its value, and its gradient in the units of the point.
template <class F>
struct NoiseSample {
  F value;
  Vector<F> gradient;
  F lost_variance{0.0f};  ///< of a fractal sum: the variance that its fading removed
};

namespace noise_parts {

/// One coordinate: the lattice cell modulo 256, the position t in it, and Perlin's fade of t with its derivative.
template <class F>
struct Axis {
  typename F::Int cell;
  F t, fade, slope;
};

template <class F>
[[gnu::always_inline]] inline Axis<F> axis(F x) {
  using Int = typename F::Int;
  // The period is removed before the conversion to integers. Infinities and NaN become cell 0.
  const F whole = floor(x), periodic = whole - floor(whole * F(1.0f / 256)) * F(256.0f);
  const F t = min(max(x - whole, F(0.0f)), F(1.0f));
  const Int cell = truncate(min(max(periodic, F(0.0f)), F(255.0f)));
  const F fade = t * t * t * (t * (t * F(6.0f) - F(15.0f)) + F(10.0f));
  const F rest = t * (t - F(1.0f));
  return {cell, t, fade, F(30.0f) * (rest * rest)};
}

template <class F>
[[gnu::always_inline]] inline F mix(F a, F b, F weight) {
  return a + (b - a) * weight;
}

template <class F>
[[gnu::always_inline]] inline Vector<F> mix(Vector<F> a, Vector<F> b, F weight) {
  return a + (b - a) * weight;
}

/// The linear function of a corner of the cell: its gradient times the way from it.
template <class F>
[[gnu::always_inline]] inline NoiseSample<F> corner(typename F::Int hash, F x, F y, F z) {
  using Int = typename F::Int;
  const Int which = hash & Int(15);
  const Vector<F> g{F::from(Int::look_up(NoiseTables::gradient[0], which)),
                    F::from(Int::look_up(NoiseTables::gradient[1], which)),
                    F::from(Int::look_up(NoiseTables::gradient[2], which))};
  return {g.x * x + g.y * y + g.z * z, g};
}

/// Both linear functions mixed by `fade` along an axis, whose derivative `slope` is added to gradient component c.
template <class F>
[[gnu::always_inline]] inline NoiseSample<F> blend(const NoiseSample<F>& a, const NoiseSample<F>& b,
                                                   const Axis<F>& along, F Vector<F>::*component) {
  NoiseSample<F> out{mix(a.value, b.value, along.fade), mix(a.gradient, b.gradient, along.fade)};
  out.gradient.*component = out.gradient.*component + (b.value - a.value) * along.slope;
  return out;
}

}  // namespace noise_parts

/// Perlin's improved noise in three dimensions, with its analytic gradient; two-dimensional noise is the slice z = 0.
///
/// Units     one lattice cell per unit; the noise has the period 256 along each axis, is 0 at lattice points, and lies
///           in [-1.04, 1.04].
/// Edges     coordinates that are not finite count as 0.
/// Source    Perlin, Improving Noise, SIGGRAPH 2002.
template <class F>
[[gnu::always_inline]] inline NoiseSample<F> gradient_noise(Vector<F> p) {
  using namespace noise_parts;
  using Int = typename F::Int;
  const Axis<F> x = axis(p.x), y = axis(p.y), z = axis(p.z);
  const auto permuted = [](Int i) { return Int::gather(noise_tables.permutation, i); };
  const F x1 = x.t - F(1.0f), y1 = y.t - F(1.0f), z1 = z.t - F(1.0f);
  // The hash of corner (i, j, k) is P[P[P[X + i] + Y + j] + Z + k].
  NoiseSample<F> of[2][2];
  const Int a = permuted(x.cell) + y.cell, b = permuted(x.cell + Int(1)) + y.cell;
  for (int j = 0; j < 2; ++j) {
    const Int left = permuted(a + Int(j)) + z.cell, right = permuted(b + Int(j)) + z.cell;
    for (int k = 0; k < 2; ++k) {
      const F dy = j == 0 ? y.t : y1, dz = k == 0 ? z.t : z1;
      of[j][k] = blend(corner<F>(permuted(left + Int(k)), x.t, dy, dz), corner<F>(permuted(right + Int(k)), x1, dy, dz),
                       x, &Vector<F>::x);
    }
  }
  return blend(blend(of[0][0], of[1][0], y, &Vector<F>::y), blend(of[0][1], of[1][1], y, &Vector<F>::y), z,
               &Vector<F>::z);
}

/// The octaves of a fractal sum: octave i has 2^i times the frequency and gain^i times the amplitude of the first.
struct Octaves {
  static constexpr int most = 12;
  int count = 5;
  float gain = 0.5f;
};

/// The amplitude with which noise contributes to its mean over a pixel: the regression coefficient of the mean on the
/// noise in the middle of the pixel, e^(-rate s²), fitted to 20,000 pixels of 0.1 to 1 cells.
///
/// `square` is the sum of the squares of the pixel's two sides, in lattice cells.
template <class F>
[[gnu::always_inline]] inline F noise_fade(F square, bool is_turbulence) {
  return exp(min(square, F(100.0f)) * F(is_turbulence ? -0.68f : -0.265f));
}

/// The fractal sum Σ gain^i noise(2^i p), with its gradient. Each octave is faded by noise_fade; `square` is that of
/// the first octave.
///
/// With `is_turbulence` the octaves' absolute values are added, and an octave that is too fine for the pixels counts
/// with its mean.
/// Source    Perlin, An Image Synthesizer, SIGGRAPH 1985.
template <class F>
[[gnu::always_inline]] inline NoiseSample<F> fractal_noise(Vector<F> p, F square, const Octaves& octaves,
                                                           bool is_turbulence) {
  // Of noise and of |noise|, measured over 5 × 10^6 points.
  constexpr float mean_magnitude = 0.2204f, variance_of_noise = 0.0731f, variance_of_magnitude = 0.0246f;
  NoiseSample<F> sum{F(0.0f), {F(0.0f), F(0.0f), F(0.0f)}, F(0.0f)};
  float frequency = 1, amplitude = 1;
  for (int i = 0; i < octaves.count; ++i) {
    NoiseSample<F> n = gradient_noise<F>(p * F(frequency));
    const F weight = noise_fade<F>(square * F(frequency * frequency), is_turbulence);
    const F variance(amplitude * amplitude * (is_turbulence ? variance_of_magnitude : variance_of_noise));
    sum.lost_variance = sum.lost_variance + (F(1.0f) - weight * weight) * variance;
    if (is_turbulence) {
      const F sign = select(n.value < F(0.0f), F(-1.0f), F(1.0f));
      n.value = F(mean_magnitude) + (n.value * sign - F(mean_magnitude)) * weight;
      n.gradient = n.gradient * (sign * weight);
    } else {
      n.value = n.value * weight;
      n.gradient = n.gradient * weight;
    }
    sum.value = sum.value + n.value * F(amplitude);
    sum.gradient = sum.gradient + n.gradient * F(amplitude * frequency);
    frequency *= 2, amplitude *= octaves.gain;
  }
  return sum;
}

}  // namespace zoneplate
