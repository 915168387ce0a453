// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace zoneplate {

/// The discrete Fourier transform of one size, applied to four signals side by side.
///
/// X[k] = Σ_j x[j] e^(-2πi jk / n), not normalized. A size whose prime factors are at most `max_radix` is
/// transformed by mixed radices (Stockham's self-sorting form); any other by a convolution (Bluestein's chirp).
///
/// This implementation exists because the same bits are guaranteed on every machine. KissFFT (as packaged by Debian)
/// computes its roots of unity with the C library, whose sin has variants per processor, and accepts no others: its
/// spectra of 480, 640, 1000, 1024 and 4096 values change when glibc's FMA variants are disabled.
///
/// Shape     element j of signal l is at index 4 j + l of `re` and `im`; n >= 1.
/// Exact     each signal's result is independent of the others; the error is about 1e-16 √(log n) of the greatest
///           magnitude.
/// Cost      O(n log n) for every n.
/// Source    Stockham, High-speed convolution and correlation, AFIPS 1966; Bluestein, A linear filtering approach to
///           the computation of the discrete Fourier transform, IEEE Trans. Audio 18(4), 1970.
class FourierPlan {
 public:
  static constexpr std::size_t lanes = 4;
  static constexpr std::size_t max_radix = 31;

  explicit FourierPlan(std::size_t n);

  std::size_t size() const { return n_; }

  /// A scratch buffer, one per thread; its initial contents are irrelevant.
  std::vector<double> make_scratch() const { return std::vector<double>(scratch_size_); }

  /// Transforms in place. `forward(im, re, scratch)` is the inverse transform times n.
  void forward(double* re, double* im, std::vector<double>& scratch) const { forward(re, im, scratch.data()); }

 private:
  struct Stage {
    // Groups = (size not yet transformed) / radix, stride = product of the previous radices.
    std::size_t radix, groups, stride;
  };

  void forward(double* re, double* im, double* scratch) const;
  void run_stages(double* re, double* im, double* scratch) const;
  void run_chirp(double* re, double* im, double* scratch) const;

  std::size_t n_;
  std::size_t scratch_size_;
  std::vector<Stage> stages_;
  std::vector<double> cos_, sin_;              // e^(-2πi k/n) = cos_[k] + i sin_[k]; with Bluestein, the chirp
  std::vector<double> filter_re_, filter_im_;  // Bluestein: the chirp's spectrum, scaled
  std::unique_ptr<FourierPlan> padded_;        // Bluestein: the transform for the convolution
};

/// The least size >= n without prime factors above 5, for padding.
std::size_t fast_size(std::size_t n);

}  // namespace zoneplate
