// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/cvvdp/pyramid.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

constexpr std::array<double, 5> filter = {0.05, 0.25, 0.4, 0.25, 0.05};

/// The index mirrored into [0, n); the border's pixel is repeated.
int mirrored(int i, int n) { return i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i; }

Plane<double> transposed(const Plane<double>& in) {
  Plane<double> out(in.height(), in.width());
  for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x) out(x, y) = in(y, x);
  });
  return out;
}

Plane<double> reduce_rows(const Plane<double>& in) {
  Plane<double> out((in.width() + 1) / 2, in.height());
  for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x) {
      for (int k = 0; k < 5; ++k) {
        out(x, y) += filter[static_cast<std::size_t>(k)] * in(mirrored(2 * x + k - 2, in.width()), y);
      }
    }
  });
  return out;
}

/// Doubles the width: inserts zeros between the values of each row, repeats the first and the last value, and convolves
/// with twice the filter.
Plane<double> expand_rows(const Plane<double>& in, int width) {
  Plane<double> out(width, in.height());
  for_rows(out.height(), [&](int y) {
    std::vector<double> spaced(static_cast<std::size_t>(width) + 4, 0.0);
    for (int x = 0; x < in.width(); ++x) spaced[static_cast<std::size_t>(2 * x + 2)] = in(x, y);
    spaced[0] = in(0, y);
    spaced[static_cast<std::size_t>(width + 2 + width % 2)] = in(in.width() - 1, y);
    for (int x = 0; x < width; ++x) {
      double sum = 0;
      for (std::size_t k = 0; k < 5; ++k) sum += filter[k] * spaced[static_cast<std::size_t>(x) + k];
      out(x, y) = 2 * sum;
    }
  });
  return out;
}

}  // namespace

Plane<double> reduce(const Plane<double>& in) {
  assert(in.width() >= 2 && in.height() >= 2);
  return transposed(reduce_rows(transposed(reduce_rows(in))));
}

Plane<double> expand(const Plane<double>& in, int width, int height) {
  assert(in.width() == (width + 1) / 2 && in.height() == (height + 1) / 2);
  return transposed(expand_rows(transposed(expand_rows(in, width)), height));
}

std::vector<double> band_frequencies(int width, int height, double pixels_per_degree) {
  // One band for each halving of the shorter side; none after the first whose peak is at most 0.2 cycles per degree.
  int levels = -1;
  for (int side = std::min(width, height); side > 1; side /= 2) ++levels;
  std::vector<double> frequencies;
  double frequency = 1;
  for (int i = 0; i < levels; ++i) {
    frequencies.push_back(frequency * pixels_per_degree / 2);
    if (frequencies.back() <= 0.2) break;
    frequency = i == 0 ? 0.3228 : frequency / 2;
  }
  frequencies.push_back(0.1);
  return frequencies;
}

}  // namespace zoneplate::metrics
