// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/aliasing.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/signal/fourier/fourier.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

double decibels(double power) { return power > 0 ? 10 / 2.302585092994046 * natural_log(power) : -400; }

double mean_square(const Plane<float>& plane) {
  double sum = 0;
  for (const float v : plane.values()) sum += static_cast<double>(v) * static_cast<double>(v);
  return sum / static_cast<double>(plane.values().size());
}

double variance(const Plane<float>& plane) {
  double sum = 0;
  for (const float v : plane.values()) sum += static_cast<double>(v);
  const double mean = sum / static_cast<double>(plane.values().size());
  return mean_square(plane) - mean * mean;
}

Plane<float> difference(const Plane<float>& a, const Plane<float>& b) {
  Plane<float> out = a;
  for (std::size_t i = 0; i < out.values().size(); ++i) out.values()[i] -= b.values()[i];
  return out;
}

// A plane split into frequencies below `fx` and `fy` cycles per pixel, and the others.
struct Split {
  Plane<float> low, high;
};
Split split(const Plane<float>& plane, double fx, double fy) {
  Spectrum spectrum = fourier(plane);
  for (int y = 0; y < spectrum.height(); ++y)
    for (int x = 0; x < spectrum.half.width(); ++x)
      if (std::abs(bin_frequency(x, plane.width())) >= fx || std::abs(bin_frequency(y, plane.height())) >= fy)
        spectrum.half(x, y) = 0;
  Split out{inverse_fourier(spectrum), {}};
  out.high = difference(plane, out.low);
  return out;
}

}  // namespace

Plane<float> zone_plate(int size) {
  Plane<float> out(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      // r² in quarters of a square pixel is an integer: the angle is reduced exactly.
      const std::int64_t dx = 2 * x + 1 - size, dy = 2 * y + 1 - size;
      const auto turns = static_cast<std::uint64_t>((dx * dx + dy * dy) % (8 * std::int64_t{size}));
      out(x, y) = static_cast<float>(0.5 + 0.5 * unit_root(turns, 8 * static_cast<std::uint64_t>(size)).cosine);
    }
  return out;
}

AliasFigures measure_aliases(const Plane<float>& plane, int width, int height, const Kernel& kernel) {
  assert(!plane.empty() && width > 0 && height > 0);
  const double fx = 0.5 * width / plane.width(), fy = 0.5 * height / plane.height();
  const auto resampled = [&](const Plane<float>& part) {
    return resample(part, width, height, kernel, {.border = Border::Wrap});
  };
  const Split all = split(plane, fx, fy), far = split(plane, 1.5 * fx, 1.5 * fy), half = split(plane, fx / 2, fy / 2);
  const auto error = [&](const Plane<float>& part) {
    const Plane<float> ideal = resample_ideal(part, width, height);
    return decibels(mean_square(difference(resampled(part), ideal)) / variance(ideal));
  };
  return {.all_db = decibels(mean_square(resampled(all.high)) / mean_square(all.high)),
          .far_db = decibels(mean_square(resampled(far.high)) / mean_square(far.high)),
          .pass_db = error(all.low),
          .pass_half_db = error(half.low)};
}

namespace {

// Statistics of the weights' response to a wave of frequency f, in cycles per input pixel: means over the phases.
struct MeanResponse {
  double square = 0;  // mean of |response|²
  double real = 0;    // mean of the component in phase with the ideal response
};
MeanResponse response_of(const std::vector<PixelWeights>& phases, const std::vector<double>& centres, double f) {
  MeanResponse sum;
  for (std::size_t p = 0; p < phases.size(); ++p) {
    double re = 0, im = 0;
    for (std::size_t t = 0; t < phases[p].weights.size(); ++t) {
      const SineCosine wave = sin_cos_pi(2 * f * (phases[p].first + static_cast<int>(t) - centres[p]));
      re += phases[p].weights[t] * wave.cosine, im += phases[p].weights[t] * wave.sine;
    }
    sum.square += re * re + im * im, sum.real += re;
  }
  const double n = static_cast<double>(phases.size());
  return {sum.square / n, sum.real / n};
}

}  // namespace

AliasFigures predict_aliases(const Kernel& kernel, double factor) {
  assert(factor >= 1);
  std::vector<PixelWeights> phases;
  std::vector<double> centres;
  for (int i = 0; i < 20; ++i) {
    const double centre = (i + 0.5) * factor - 0.5;
    centres.push_back(centre - std::floor(centre));
    phases.push_back(pixel_weights(kernel, centres.back(), factor));
  }

  // Integrals over [0, f] by the midpoint rule.
  struct Sums {
    double square = 0, linear = 0, length = 0;
  };
  const auto up_to = [&](double f) {
    constexpr int steps = 100;
    Sums sums{0, 0, f};
    for (int i = 0; i < steps; ++i) {
      const MeanResponse r = response_of(phases, centres, f * (i + 0.5) / steps);
      sums.square += r.square * f / steps, sums.linear += r.real * f / steps;
    }
    return sums;
  };
  const double nyquist = 0.5 / factor;
  const Sums whole = up_to(0.5), near = up_to(std::min(0.5, 1.5 * nyquist)), low = up_to(nyquist),
             half = up_to(nyquist / 2);

  // The response is a product of one in x and one in y: the mean of its square over a square of frequencies is the
  // product of two equal means, and the region outside a smaller square is a difference.
  const auto outside = [&](const Sums& in) {
    const double area = whole.length * whole.length - in.length * in.length;
    return area > 0 ? decibels((whole.square * whole.square - in.square * in.square) / area) : -400.0;
  };
  // The mean of (1 - Hx Hy)².
  const auto error = [](const Sums& in) {
    const double area = in.length * in.length;
    return decibels((area - 2 * in.linear * in.linear + in.square * in.square) / area);
  };
  return {.all_db = outside(low), .far_db = outside(near), .pass_db = error(low), .pass_half_db = error(half)};
}

}  // namespace zoneplate
