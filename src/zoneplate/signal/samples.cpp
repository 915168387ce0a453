// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

/// A position with coordinates in [0, 1), rounded down to 1/256.
SamplePosition at(double x, double y) {
  const auto cell = [](double v) {
    return static_cast<std::uint8_t>(std::clamp(static_cast<int>(std::floor(v * 256)), 0, 255));
  };
  return {cell(x), cell(y)};
}

/// A position in sixteenths of a pixel from the pixel's centre, the unit of the standard patterns.
SamplePosition sixteenths(int x, int y) {
  return {static_cast<std::uint8_t>(128 + 16 * x), static_cast<std::uint8_t>(128 + 16 * y)};
}

/// Positions moved by the distance of their mean from the pixel's centre, and rounded to 1/256.
///
/// The few that would leave the pixel stay at its border; the mean is at the centre within 1/512 all the same.
SamplePattern centred(const std::vector<std::pair<double, double>>& points) {
  double sum_x = 0, sum_y = 0;
  for (const auto& [x, y] : points) sum_x += x, sum_y += y;
  const auto count = static_cast<double>(points.size());
  const auto cell = [](double from_mean) {
    return static_cast<std::uint8_t>(std::clamp(static_cast<int>(std::ceil(from_mean * 256 + 127.5)), 0, 255));
  };
  SamplePattern out;
  for (const auto& [x, y] : points) out.push_back({cell(x - sum_x / count), cell(y - sum_y / count)});
  return out;
}

double radical_inverse(unsigned base, unsigned i) {
  double value = 0, digit = 1;
  for (; i > 0; i /= base) {
    digit /= base;
    value += digit * (i % base);
  }
  return value;
}

/// The second dimension of Sobol's sequence (the first is van der Corput's). Each direction number is the previous one
/// XOR the previous one shifted right by one.
double sobol_y(unsigned i) {
  std::uint32_t bits = 0, direction = 0x80000000u;
  for (; i > 0; i >>= 1) {
    if (i & 1) bits ^= direction;
    direction ^= direction >> 1;
  }
  return bits * 0x1p-32;
}

/// (½, ½) and multiples of 1 / p and 1 / p² for the plastic number p = 1.3247...: the real root of p³ = p + 1.
///
/// Source    Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018.
std::pair<double, double> r2(unsigned i) {
  constexpr std::uint32_t step_x = 3242174889u, step_y = 2447445414u,
                          half = 0x80000000u;  // 2^32 / p, 2^32 / p², 2^32 / 2
  return {(half + i * step_x) * 0x1p-32, (half + i * step_y) * 0x1p-32};
}

SamplePattern rotated_grid(int n) {
  // The n × n grid rotated by atan(1/n) on the torus: all n² rows and columns are distinct. n = 2 is the standard
  // pattern of 4.
  const int count = n * n;
  SamplePattern out;
  for (int i = 0; i < count; ++i) out.push_back(at((i + 0.5) / count, ((n - 1 - i % n) * n + i / n + 0.5) / count));
  return out;
}

SamplePattern rooks(int count) {
  // The column of row j is the rank of element j of the golden-ratio sequence: no two samples share a row or column.
  std::vector<int> order(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) order[static_cast<std::size_t>(i)] = i;
  const auto key = [](int i) {
    const double v = (i + 1) * 0.61803398874989484820;
    return v - std::floor(v);
  };
  std::sort(order.begin(), order.end(), [&](int p, int q) { return key(p) < key(q); });
  SamplePattern out;
  for (int i = 0; i < count; ++i)
    out.push_back(at((i + 0.5) / count, (order[static_cast<std::size_t>(i)] + 0.5) / count));
  return out;
}

}  // namespace

SamplePattern standard_pattern(int n) {
  switch (n) {
    case 1:
      return {SamplePosition{}};
    case 2:
      return {sixteenths(4, 4), sixteenths(-4, -4)};
    case 4:
      return {sixteenths(-2, -6), sixteenths(6, -2), sixteenths(-6, 2), sixteenths(2, 6)};
    case 8:
      return {sixteenths(1, -3), sixteenths(-1, 3),  sixteenths(5, 1), sixteenths(-3, -5),
              sixteenths(-5, 5), sixteenths(-7, -1), sixteenths(3, 7), sixteenths(7, -7)};
    case 16:
      return {sixteenths(1, 1),   sixteenths(-1, -3), sixteenths(-3, 2),  sixteenths(4, -1),
              sixteenths(-5, -2), sixteenths(2, 5),   sixteenths(5, 3),   sixteenths(3, -5),
              sixteenths(-2, 6),  sixteenths(0, -7),  sixteenths(-4, -6), sixteenths(-6, 4),
              sixteenths(-8, 0),  sixteenths(7, -4),  sixteenths(6, 7),   sixteenths(-7, -8)};
    default:
      throw Error(ErrorKind::Usage, "standard sample patterns have 1, 2, 4, 8 or 16 samples, not " + std::to_string(n));
  }
}

SamplePattern grid_pattern(int n) {
  SamplePattern out;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) out.push_back(at((i + 0.5) / n, (j + 0.5) / n));
  return out;
}

SamplePattern named_pattern(const std::string& name, int samples) {
  if (samples < 1 || samples > 4096)
    throw Error(ErrorKind::Usage, "a pattern has 1 to 4096 samples, not " + std::to_string(samples));
  const int root = static_cast<int>(std::sqrt(samples) + 0.5);
  if ((name == "grid" || name == "rotated") && root * root != samples)
    throw Error(ErrorKind::Usage,
                "pattern " + name + " has a square number of samples, not " + std::to_string(samples));
  if (name == "grid") return grid_pattern(root);
  if (name == "rotated") return rotated_grid(root);
  if (name == "nrooks") return rooks(samples);
  // Each point of Sobol's sequence is at the corner of its cell, the first at that of the pixel; all are moved to the
  // middles.
  const double half_cell = 0.5 / std::bit_ceil(static_cast<unsigned>(samples));
  std::vector<std::pair<double, double>> points;
  for (unsigned i = 0; i < static_cast<unsigned>(samples); ++i) {
    if (name == "halton")
      points.emplace_back(radical_inverse(2, i + 1), radical_inverse(3, i + 1));
    else if (name == "r2")
      points.push_back(r2(i));
    else if (name == "sobol")
      points.emplace_back(radical_inverse(2, i) + half_cell, sobol_y(i) + half_cell);
    else
      throw Error(ErrorKind::Usage,
                  "unknown sample pattern " + name + "; there are grid, rotated, halton, r2, sobol, nrooks");
  }
  return centred(points);
}

SamplePattern halton_sequence(int samples) {
  SamplePattern out;
  for (unsigned i = 1; i <= static_cast<unsigned>(samples); ++i)
    out.push_back(at(radical_inverse(2, i), radical_inverse(3, i)));
  return out;
}

}  // namespace zoneplate
