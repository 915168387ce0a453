// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// "Padded" arrays are read and written in whole vectors: up to seven pixels after the n-th.
struct AccumulateKernels : PerIsa<AccumulateKernels> {
  /// Weights n pixels of four floats by 1 / (1 + luma × exposure), and stores the weights in `weight`. Padded.
  void (*weigh_karis)(float exposure, float* color, float* weight, std::size_t n);
  /// Maps the colours of n pixels by c / (1 + max(c)); alpha is unchanged. Padded.
  void (*map_max3)(float* color, std::size_t n);
  /// Premultiplies n pixels. Padded.
  void (*premultiply)(float* color, std::size_t n);

  /// rows[k][i] += down[k] × Σ_d across[d] × in[i + d × step], summed in the order of the taps, for n values.
  ///
  /// Shape     `in` and all rows are padded.
  void (*spread)(const float* in, std::size_t step, const float* across, int taps, const float* down,
                 float* const* rows, int row_count, std::size_t n);

  /// color / weight of n pixels; if `is_max3`, with the inverse mapping of map_max3. `color` and `weight` are padded,
  /// `out` is not.
  void (*mean)(const float* color, const float* weight, bool is_max3, float* out, std::size_t n);

  /// The upper limit of means before the inverse mapping: 2^21 times white.
  static constexpr float max_mapped = 1 - 0x1p-21f;
  static constexpr float luma[3] = {0.2126f, 0.7152f, 0.0722f};  ///< Rec.709
};

}  // namespace zoneplate
