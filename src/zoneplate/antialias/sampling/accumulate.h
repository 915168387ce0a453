#pragma once

#include <cstddef>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// Where eight lanes' room is said, arrays are read and written in whole vectors: up to seven pixels after the n-th.
struct AccumulateKernels : PerIsa<AccumulateKernels> {
  /// Weighs n pixels of four floats by 1 / (1 + luma × exposure); `weight` gets the weights. Eight lanes' room.
  void (*weigh_karis)(float exposure, float* color, float* weight, std::size_t n);
  /// Maps the light of n pixels by c / (1 + max(c)); alpha stays. Eight lanes' room.
  void (*map_max3)(float* color, std::size_t n);
  /// Premultiplies n pixels. Eight lanes' room.
  void (*premultiply)(float* color, std::size_t n);

  /// rows[k][i] += down[k] × Σ_d across[d] × in[i + d × step], the taps one after the other, for n values.
  ///
  /// Shape     in and all rows have eight lanes' room.
  void (*spread)(const float* in, std::size_t step, const float* across, int taps, const float* down,
                 float* const* rows, int row_count, std::size_t n);

  /// color / weight of n pixels; mapped back from map_max3 where `is_max3`. Eight lanes' room in `color` and `weight`,
  /// none in `out`.
  void (*mean)(const float* color, const float* weight, bool is_max3, float* out, std::size_t n);

  /// The greatest mean that is mapped back: 2^21 times white.
  static constexpr float greatest_mapped = 1 - 0x1p-21f;
  static constexpr float luma[3] = {0.2126f, 0.7152f, 0.0722f};  ///< Rec.709
};

}  // namespace zoneplate
