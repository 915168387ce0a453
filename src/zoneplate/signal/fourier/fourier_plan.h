// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace zoneplate {

/// The discrete Fourier transform of one size, ready to be applied to four signals side by side.
///
/// X[k] = Σ_j x[j] e^(-2πi jk / n), not scaled. A size whose prime factors are at most `greatest_radix` is
/// transformed by mixed radices (Stockham's self-sorting form); any other becomes a convolution (Bluestein's chirp).
///
/// A transform of our own, because the same bits are promised on every machine: KissFFT (as Debian has it) takes its
/// roots of unity from the C library, whose sin has variants per processor, and cannot be given others. Measured:
/// its spectra of 480, 640, 1000, 1024 and 4096 values change their bits when glibc's FMA variants are switched off.
///
/// Shape     element j of signal l is at index 4 j + l of `re` and `im`; n >= 1.
/// Exact     each signal's result depends on that signal alone; the error is about 1e-16 √(log n) of the greatest.
/// Cost      O(n log n) for every n.
/// Source    Stockham, High-speed convolution and correlation, AFIPS 1966; Bluestein, A linear filtering approach to
///           the computation of the discrete Fourier transform, IEEE Trans. Audio 18(4), 1970.
class FourierPlan {
 public:
  static constexpr std::size_t lanes = 4;
  static constexpr std::size_t greatest_radix = 31;

  explicit FourierPlan(std::size_t n);

  std::size_t size() const { return n_; }

  /// Room that one call needs; one for each thread, its contents do not matter.
  std::vector<double> make_scratch() const { return std::vector<double>(scratch_size_); }

  /// Transforms in place. The inverse, times n, is `forward(im, re, scratch)`.
  void forward(double* re, double* im, std::vector<double>& scratch) const { forward(re, im, scratch.data()); }

 private:
  struct Stage {
    std::size_t radix, groups, stride;  // groups = (what is left of n) / radix, stride = product of the radices done
  };

  void forward(double* re, double* im, double* scratch) const;
  void run_stages(double* re, double* im, double* scratch) const;
  void run_chirp(double* re, double* im, double* scratch) const;

  std::size_t n_;
  std::size_t scratch_size_;
  std::vector<Stage> stages_;
  std::vector<double> cos_, sin_;              // e^(-2πi k/n) = cos_[k] + i sin_[k]; of the chirp where that is used
  std::vector<double> filter_re_, filter_im_;  // Bluestein: the chirp's spectrum, scaled
  std::unique_ptr<FourierPlan> padded_;        // Bluestein: the transform that convolves
};

/// The least size >= n without prime factors above 5: a good size to pad to.
std::size_t fast_size(std::size_t n);

}  // namespace zoneplate
