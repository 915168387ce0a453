// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/solid_texture.h"
#include "zoneplate/shade/texture/solid_texture.h"
#include "zoneplate/signal/pattern/gradient_noise.h"

/// The kernel of shade/texture/solid_texture.h, over the lane types of math/lanes.h.
namespace zoneplate::stages {

/// A fragment's point in lattice cells, and its derivatives per pixel.
template <class F>
struct SolidPoint {
  Vector<F> p, dx, dy;

  /// The sum of the squares of the pixel's sides, as noise_fade takes it.
  [[gnu::always_inline]] F square() const { return dot(dx, dx) + dot(dy, dy); }
};

/// sin(πx) / (πx): the response of a box filter one pixel wide to a wave of x cycles per pixel.
template <class F>
[[gnu::always_inline]] inline F box_response(F x) {
  const F angle = min(abs(x), F(1000.0f)) * F(3.14159265f);
  return select(angle > F(1e-3f), sin(angle) / max(angle, F(1e-3f)), F(1.0f));
}

/// A phase in cycles, its change per pixel along x and y, and the variance of its unresolved part.
template <class F>
struct Phase {
  F value, dx, dy, variance;

  [[gnu::always_inline]] Phase(F at, Vector<F> gradient, F lost_variance, const SolidPoint<F>& point)
      : value(at), dx(dot(gradient, point.dx)), dy(dot(gradient, point.dy)), variance(lost_variance) {}
  /// The response of the pixel to harmonic k: of a box to a wave, times the mean of cos(2πk δ) over normally
  /// distributed displacements δ of the phase.
  [[gnu::always_inline]] F response(float k) const {
    constexpr float two_pi_squared = 19.7392088f;
    return box_response<F>(dx * F(k)) * box_response<F>(dy * F(k)) *
           exp(min(variance, F(100.0f)) * F(-two_pi_squared * k * k));
  }
  /// The angle of harmonic k, with whole cycles removed.
  [[gnu::always_inline]] F angle(float k) const { return (value - floor(value)) * F(k * 6.28318531f); }
};

/// The sum of the amplitudes of all octaves.
inline float total_amplitude(const Octaves& octaves) {
  float sum = 0, amplitude = 1;
  for (int i = 0; i < octaves.count; ++i) sum += amplitude, amplitude *= octaves.gain;
  return sum;
}

template <class F>
[[gnu::always_inline]] inline F noise_pattern(const SolidPoint<F>& at, const Octaves& octaves, bool is_turbulence) {
  const F sum = fractal_noise<F>(at.p, at.square(), octaves, is_turbulence).value;
  if (is_turbulence) return sum;
  return F(0.5f) + sum * F(1 / total_amplitude(octaves));
}

/// Veins: ((1 + cos φ) / 2)³, which is 10/32 + 15/32 cos φ + 6/32 cos 2φ + 1/32 cos 3φ.
template <class F>
[[gnu::always_inline]] inline F marble_pattern(const SolidPoint<F>& at, const Octaves& octaves, float distortion) {
  const NoiseSample<F> n = fractal_noise<F>(at.p, at.square(), octaves, true);
  Vector<F> gradient = n.gradient * F(distortion);
  gradient.x = gradient.x + F(1.0f);
  const Phase<F> phase(at.p.x + n.value * F(distortion), gradient, n.lost_variance * F(distortion * distortion), at);
  constexpr float harmonic[3] = {15.0f / 32, 6.0f / 32, 1.0f / 32};
  F sum(10.0f / 32);
  for (int k = 0; k < 3; ++k) {
    const auto order = static_cast<float>(k + 1);
    sum = sum + cos(phase.angle(order)) * phase.response(order) * F(harmonic[k]);
  }
  return sum;
}

/// Annual rings: a sawtooth of four harmonics with Lanczos' sigma factors, slowly darker towards the outside of each
/// ring, and a grain of noise that is stretched along the trunk.
template <class F>
[[gnu::always_inline]] inline F wood_pattern(const SolidPoint<F>& at, float distortion) {
  constexpr Octaves two{2, 0.5f};
  const Vector<F> stretch{F(0.5f), F(0.08f), F(0.5f)};
  const SolidPoint<F> bent{at.p * stretch, at.dx * stretch, at.dy * stretch};
  const NoiseSample<F> n = fractal_noise<F>(bent.p, bent.square(), two, false);
  const F radius = sqrt(at.p.x * at.p.x + at.p.z * at.p.z), inverse = F(1.0f) / max(radius, F(1e-6f));
  const Vector<F> outwards{at.p.x * inverse, F(0.0f), at.p.z * inverse};
  const Phase<F> phase(radius + n.value * F(distortion), outwards + n.gradient * stretch * F(distortion),
                       n.lost_variance * F(distortion * distortion), at);
  // sin(πk/5) / (πk/5) / (πk).
  constexpr float harmonic[4] = {0.29778f, 0.12045f, 0.05353f, 0.01861f};
  F ring(0.5f);
  for (int k = 0; k < 4; ++k) {
    const auto order = static_cast<float>(k + 1);
    ring = ring - sin(phase.angle(order)) * phase.response(order) * F(harmonic[k]);
  }
  const Vector<F> fine{F(12.0f), F(0.4f), F(12.0f)};
  const SolidPoint<F> grain{at.p * fine, at.dx * fine, at.dy * fine};
  return ring + fractal_noise<F>(grain.p, grain.square(), two, false).value * F(0.12f);
}

/// Mottled noise, darkened along the creases of turbulence.
template <class F>
[[gnu::always_inline]] inline F rock_pattern(const SolidPoint<F>& at, const Octaves& octaves) {
  const F mottle = fractal_noise<F>(at.p, at.square(), octaves, false).value * F(0.9f / total_amplitude(octaves));
  const F three(3.1f);
  const SolidPoint<F> fine{at.p * three + Vector<F>{F(17.3f), F(5.7f), F(11.9f)}, at.dx * three, at.dy * three};
  const F crease = fractal_noise<F>(fine.p, fine.square(), octaves, true).value;
  return F(0.2f) + mottle + crease * F(0.75f);
}

template <class F>
void evaluate_solid_texture(const SolidTexture& texture, const SolidPoints& points, float* const out[3], int count) {
  const Octaves octaves{texture.octaves, texture.gain};
  const F scale(texture.scale), zero(0.0f), one(1.0f);
  const F change = texture.is_filtered ? scale : zero;
  const Vector<F> low{F(texture.low.x), F(texture.low.y), F(texture.low.z)};
  const Vector<F> high{F(texture.high.x), F(texture.high.y), F(texture.high.z)};
  for (int i = 0; i < count; i += F::lanes) {
    const SolidPoint<F> at{Vector<F>::load(points.position, i) * scale, Vector<F>::load(points.dx, i) * change,
                           Vector<F>::load(points.dy, i) * change};
    F value = zero;
    switch (texture.pattern) {
      case SolidPattern::None:
        break;
      case SolidPattern::Noise:
        value = noise_pattern<F>(at, octaves, false);
        break;
      case SolidPattern::Turbulence:
        value = noise_pattern<F>(at, octaves, true);
        break;
      case SolidPattern::Marble:
        value = marble_pattern<F>(at, octaves, texture.distortion);
        break;
      case SolidPattern::Wood:
        value = wood_pattern<F>(at, texture.distortion);
        break;
      case SolidPattern::Rock:
        value = rock_pattern<F>(at, octaves);
        break;
    }
    const F weight = min(max(value, zero), one);
    const Vector<F> color = low + (high - low) * weight;
    color.store(out, i);
  }
}

template <class F>
constexpr SolidTextureKernels solid_texture() {
  return {.evaluate = &evaluate_solid_texture<F>};
}

}  // namespace zoneplate::stages
