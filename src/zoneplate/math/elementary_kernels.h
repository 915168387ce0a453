#pragma once

#include <cstddef>

namespace zoneplate {

enum class Elementary { Exp2, Exp, Log2, Log, Pow, Sin, Cos, Atan2, Acos, Asin };

/// The functions of math/elementary.h over arrays.
struct ElementaryKernels {
  /// out[i] = function(a[i]), or function(a[i], b[i]) for Pow (x, y) and Atan2 (y, x); b has n values for these two.
  void (*evaluate)(Elementary function, const float* a, const float* b, float* out, std::size_t n);

  static const ElementaryKernels N_SSE4, N_AVX2, N_AVX3, N_NEON, N_WASM;  ///< one for each instruction set (base/isa.h)
};

namespace scalar {
extern const ElementaryKernels elementary_kernels;
}

}  // namespace zoneplate
