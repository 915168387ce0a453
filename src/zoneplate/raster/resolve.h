#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/image/pixel.h"
#include "zoneplate/raster/batch.h"

namespace zoneplate {

/// Sums and means of samples, for eight pixels of a row whose points stand side by side in `color` from `first` on.
///
/// Exact     in float, as written: products, sums from 0 on in the order of the samples, one division.
struct ResolveKernels {
  /// out = (0 + color × weight) / weight: one surface owns all samples.
  void (*resolve)(const Shaded& color, int first, float weight, Linear8& out);
  /// behind = color + behind × (1 - alpha of color).
  void (*over)(const Shaded& color, int first, Linear8& behind);
  /// The same for rows whose points follow each other from the first on.
  void (*over_rows)(const Shaded& color, int rows, Linear8* const* behind);
  /// out = ((0 + color × weights[0]) + color × weights[1] + ...) / weight_sum.
  void (*resolve_samples)(const Linear8& color, const float* weights, int samples, float weight_sum, Linear8& out);
  /// sum += color × weight.
  void (*add)(const Shaded& color, int first, float weight, Linear8& sum);
  /// out = sum / weight.
  void (*divide)(const Linear8& sum, float weight, Linear8& out);
  /// The pixels one by one.
  void (*put)(const Linear8& color, Linear* out);

  static const ResolveKernels N_SSE4, N_AVX2, N_AVX3, N_NEON, N_WASM;  ///< one for each instruction set (base/isa.h)
};

namespace scalar {
extern const ResolveKernels resolve_kernels;
}
inline const ResolveKernels& resolve_kernels(Isa isa) { return pick(isa, scalar::resolve_kernels); }

}  // namespace zoneplate
