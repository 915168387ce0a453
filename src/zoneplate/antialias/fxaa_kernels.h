#pragma once

#include <cstddef>
#include <cstdint>

namespace zoneplate {

/// What contrast FXAA leaves alone: the greater of `least` and the share factor / 65536 of the greatest luma.
struct FxaaContrast {
  std::uint8_t least = 0;
  std::uint16_t factor = 0;
};

struct FxaaKernels {
  /// Luma codes, (299 R + 587 G + 114 B) / 1000 rounded, of n pixels of four codes.
  void (*luma_row)(const std::uint8_t* rgba, std::uint8_t* luma, std::size_t n);
  /// Bit x of `bits` says that the contrast between pixel x of a row of luma and its four neighbours is to be treated.
  ///
  /// Shape     reads whole vectors: up to 31 values after the n-th; `bits` has room for n rounded up to 64.
  void (*contrast_row)(const std::uint8_t* luma, std::ptrdiff_t stride, FxaaContrast contrast, std::uint8_t* bits,
                       std::size_t n);
};

namespace scalar {
extern const FxaaKernels fxaa_kernels;
}
namespace N_SSE4 {
extern const FxaaKernels fxaa_kernels;
}
namespace N_AVX2 {
extern const FxaaKernels fxaa_kernels;
}

}  // namespace zoneplate
