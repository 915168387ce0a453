#pragma once

#include <cstddef>

namespace zoneplate {

struct FlipKernels {
  /// to[i] = the sum over k of taps[k] × from[k × step + i], for i in [0, n): taps in order, places side by side.
  void (*weighted_sums)(const double* from, std::size_t step, const double* taps, std::size_t count, double* to,
                        std::size_t n);

  static const FlipKernels N_SSE4, N_AVX2, N_AVX3, N_NEON, N_WASM;  ///< one for each instruction set (base/isa.h)
};

namespace scalar {
extern const FlipKernels flip_kernels;
}

}  // namespace zoneplate
