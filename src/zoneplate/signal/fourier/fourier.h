// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "zoneplate/image/plane.h"

namespace zoneplate {

using Complex = std::complex<double>;

/// The discrete Fourier transform, of any size.
///
/// X[k] = Σ_j x[j] e^(-2πi jk / n), not normalized; the inverse divides by n. In two dimensions rows and columns are
/// transformed. Bin k is the frequency k / n cycles per sample for k <= n / 2, and (k - n) / n above.
///
/// Exact     the same bits on every machine and number of threads; within about 1e-15 of the greatest magnitude.
///           Parseval: Σ |x|² = Σ |X|² / n.
/// Cost      O(n log n) for every n; a prime above 31 costs about five times as much as its neighbours.
std::vector<Complex> fourier(std::span<const Complex> signal);
std::vector<Complex> inverse_fourier(std::span<const Complex> spectrum);

/// Bins 0 to n / 2 (n / 2 + 1 of them, rounded down) of a real signal; the others are X[n - k] = conj X[k].
std::vector<Complex> fourier(std::span<const double> signal);
/// The real signal of `size` values with these bins; the imaginary parts of bins 0 and n / 2 are ignored.
///
/// Requires  spectrum.size() == size / 2 + 1.
std::vector<double> inverse_fourier(std::span<const Complex> half_spectrum, int size);

Plane<Complex> fourier(const Plane<Complex>& plane);
Plane<Complex> inverse_fourier(const Plane<Complex>& spectrum);

/// The spectrum of a real plane: the columns 0 to width / 2 determine the others.
struct Spectrum {
  int width = 0;        ///< width of the plane
  Plane<Complex> half;  ///< (width / 2 + 1) × height bins, frequency 0 at (0, 0)

  int height() const { return half.height(); }
  /// The bin (kx, ky); both are taken modulo the size.
  Complex at(int kx, int ky) const;
};

Spectrum fourier(const Plane<float>& plane);
Spectrum fourier(const Plane<double>& plane);

/// The real plane of a spectrum, computed in double.
Plane<float> inverse_fourier(const Spectrum& spectrum);
Plane<double> inverse_fourier_double(const Spectrum& spectrum);

/// The signed frequency of bin k of n, in cycles per sample, in (-½, ½].
constexpr double bin_frequency(int k, int n) {
  return static_cast<double>(2 * k <= n ? k : k - n) / static_cast<double>(n);
}

}  // namespace zoneplate
