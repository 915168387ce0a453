#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/raster/batch.h"

namespace zoneplate {

/// Sums and means of samples, for eight pixels of a row whose points stand side by side in `color` from `first` on.
///
/// Exact     in float, as written: products, sums from 0 on in the order of the samples, one division.
struct ResolveKernels {
  /// out = (0 + color × weight) / weight: one surface owns all samples.
  void (*resolve)(const Shaded& color, int first, float weight, Linear* out);
  /// behind = color + behind × (1 - alpha of color), of eight points as r, g, b and a of each: 32 floats.
  void (*over)(const float* color, float* behind);
  /// out = ((0 + color × weights[0]) + color × weights[1] + ...) / weight_sum, of such eight points.
  void (*resolve_samples)(const float* color, const float* weights, int samples, float weight_sum, Linear* out);
  /// sum += color × weight.
  void (*add)(const Shaded& color, int first, float weight, Linear* sum);
  /// out = sum / weight, for n pixels.
  void (*divide)(const Linear* sum, float weight, int n, Linear* out);

  static const ResolveKernels N_SSE4, N_AVX2, N_AVX3, N_NEON, N_WASM;  ///< one for each instruction set (base/isa.h)
};

namespace scalar {
extern const ResolveKernels resolve_kernels;
}
inline const ResolveKernels& resolve_kernels(Isa isa) { return pick(isa, scalar::resolve_kernels); }

}  // namespace zoneplate
