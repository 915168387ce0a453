// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <string>

#include "zoneplate/base/error.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {

using std::numbers::pi;

const char* name_of(Wave wave) {
  static constexpr const char* names[] = {"square", "sawtooth", "triangle"};
  return names[static_cast<int>(wave)];
}

Wave parse_wave(std::string_view name) {
  for (const Wave wave : {Wave::Square, Wave::Sawtooth, Wave::Triangle})
    if (name == name_of(wave)) return wave;
  throw Error(ErrorKind::Usage, fmt::format("no wave '{}'; expected square, sawtooth or triangle", name));
}

double wave_value(Wave wave, double x) {
  const double t = x - std::floor(x);
  switch (wave) {
    case Wave::Square:
      return t == 0 || t == 0.5 ? 0 : t < 0.5 ? 1 : -1;
    case Wave::Sawtooth:
      return t == 0 ? 0 : 2 * t - 1;
    case Wave::Triangle:
      break;
  }
  return t < 0.25 ? 4 * t : t < 0.75 ? 2 - 4 * t : 4 * t - 4;
}

double harmonic(Wave wave, int n) {
  assert(n >= 1);
  switch (wave) {
    case Wave::Square:
      return n % 2 == 1 ? 4 / (pi * n) : 0;
    case Wave::Sawtooth:
      return -2 / (pi * n);
    case Wave::Triangle:
      break;
  }
  return n % 2 == 0 ? 0 : (n % 4 == 1 ? 8 : -8) / (pi * n * (pi * n));
}

double partial_sum(Wave wave, int highest, double x) {
  double sum = 0;
  for (int n = highest; n >= 1; --n) sum += harmonic(wave, n) * sin_pi(2 * n * x);
  return sum;
}

double apparent_frequency(double frequency, double rate) {
  assert(rate > 0);
  return frequency - rate * std::ceil(frequency / rate - 0.5);
}

double folded_frequency(double frequency, double rate) { return std::abs(apparent_frequency(frequency, rate)); }

std::vector<double> aliases_of(double frequency, double rate, double highest) {
  assert(rate > 0);
  const double base = folded_frequency(frequency, rate);
  std::vector<double> out;
  for (int k = 0; k * rate - base <= highest; ++k)
    for (const double f : {k * rate - base, k * rate + base})
      if (f > 0 && f <= highest && (out.empty() || f > out.back())) out.push_back(f);
  return out;
}

double shutter_contrast(double cycles) { return std::abs(sinc(cycles)); }

Band overlap_of_copies(double bandwidth, double rate) { return {rate - bandwidth, bandwidth}; }

}  // namespace zoneplate
