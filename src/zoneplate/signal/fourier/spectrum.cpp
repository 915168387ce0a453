// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/spectrum.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

constexpr std::size_t block_rows = 32;  // rows per partial sum; partial sums are added in their order

double power_of(Complex z) { return z.real() * z.real() + z.imag() * z.imag(); }

// Calls body(block, y) for the rows of each block of the half spectrum.
template <class Body>
void for_half_rows(const Spectrum& spectrum, const Body& body) {
  parallel_ranges(static_cast<std::size_t>(spectrum.height()), block_rows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) body(begin / block_rows, static_cast<int>(y));
  });
}

std::size_t blocks_of(const Spectrum& spectrum) {
  return (static_cast<std::size_t>(spectrum.height()) + block_rows - 1) / block_rows;
}

// The number of bins of the whole spectrum that a bin of the half represents.
int copies(int x, int width) { return x == 0 || 2 * x == width ? 1 : 2; }

double radius_of(const Spectrum& spectrum, int x, int y) {
  const double fx = bin_frequency(x, spectrum.width), fy = bin_frequency(y, spectrum.height());
  return std::sqrt(fx * fx + fy * fy);
}

// Evaluates value(z) at every pixel of the centred image, multiplied by `mirror_sign` at conjugate bins.
template <class Value>
Plane<float> centred(const Spectrum& spectrum, float mirror_sign, const Value& value) {
  const int w = spectrum.width, h = spectrum.height();
  Plane<float> out(w, h);
  for_half_rows(spectrum, [&](std::size_t, int y) {
    const auto row = spectrum.half.row(y);
    const int to = (y + h / 2) % h, mirrored = ((h - y) % h + h / 2) % h;
    for (int x = 0; 2 * x <= w; ++x) {
      const float v = value(row[static_cast<std::size_t>(x)]);
      if (2 * x == w) {
        out(0, to) = v;
        continue;
      }
      out(x + w / 2, to) = v;
      if (x > 0) out(w / 2 - x, mirrored) = mirror_sign * v;
    }
  });
  return out;
}

}  // namespace

Plane<float> centred_log_magnitude(const Spectrum& spectrum, double range_db) {
  assert(range_db > 0);
  std::vector<double> greatest(blocks_of(spectrum));
  for_half_rows(spectrum, [&](std::size_t block, int y) {
    for (const Complex& z : spectrum.half.row(y)) greatest[block] = std::max(greatest[block], power_of(z));
  });
  double peak = 0;
  for (const double g : greatest) peak = std::max(peak, g);
  if (peak == 0) return Plane<float>(spectrum.width, spectrum.height());

  // (10 log10(power / peak) + range) / range.
  const double scale = 10 / 2.302585092994046 / range_db;
  return centred(spectrum, 1, [&](Complex z) {
    const double relative = power_of(z) / peak;
    return relative > 0 ? static_cast<float>(std::max(0.0, 1 + scale * natural_log(relative))) : 0.0f;
  });
}

Plane<float> centred_phase(const Spectrum& spectrum) {
  return centred(spectrum, -1, [](Complex z) { return static_cast<float>(angle_of(z.imag(), z.real())); });
}

RadialProfile radial_profile(const Spectrum& spectrum, int rings) {
  assert(rings >= 1);
  RadialProfile out{0.5 / rings, {}, {}};
  const auto count = static_cast<std::size_t>(std::floor(0.70710678118654757 / out.ring_width)) + 1;
  out.power.resize(count), out.bins.resize(count);
  if (spectrum.half.empty()) return out;

  struct Part {
    std::vector<double> power;
    std::vector<std::int64_t> bins;
  };
  std::vector<Part> parts(blocks_of(spectrum), Part{std::vector<double>(count), std::vector<std::int64_t>(count)});
  for_half_rows(spectrum, [&](std::size_t block, int y) {
    for (int x = 0; x < spectrum.half.width(); ++x) {
      const auto ring = std::min(count - 1, static_cast<std::size_t>(radius_of(spectrum, x, y) / out.ring_width));
      parts[block].power[ring] += copies(x, spectrum.width) * power_of(spectrum.half(x, y));
      parts[block].bins[ring] += copies(x, spectrum.width);
    }
  });
  for (const Part& part : parts)
    for (std::size_t i = 0; i < count; ++i) out.power[i] += part.power[i], out.bins[i] += part.bins[i];
  const double pixels = static_cast<double>(spectrum.width) * spectrum.height();
  for (std::size_t i = 0; i < count; ++i)
    if (out.bins[i] > 0) out.power[i] /= static_cast<double>(out.bins[i]) * pixels * pixels;
  return out;
}

double energy_between(const Spectrum& spectrum, double low, double high) {
  std::vector<double> parts(blocks_of(spectrum));
  for_half_rows(spectrum, [&](std::size_t block, int y) {
    for (int x = 0; x < spectrum.half.width(); ++x)
      if (const double f = radius_of(spectrum, x, y); f >= low && f < high)
        parts[block] += copies(x, spectrum.width) * power_of(spectrum.half(x, y));
  });
  double sum = 0;
  for (const double p : parts) sum += p;
  const double pixels = static_cast<double>(spectrum.width) * spectrum.height();
  return pixels > 0 ? sum / (pixels * pixels) : 0;
}

}  // namespace zoneplate
