#pragma once

#include <cstddef>
#include <cstdint>

namespace zoneplate {

/// What contrast FXAA leaves alone: the greater of `least` and the share factor / 65536 of the greatest luma.
struct FxaaContrast {
  std::uint8_t least = 0;
  std::uint16_t factor = 0;
};

/// What the search along edges finds for the pixels of a row: an array each.
struct FxaaEnds {
  enum : int {
    level = 1,        ///< the edge is horizontal
    second_side = 2,  ///< it lies between the pixel and the one below or on the right
    bends = 4,        ///< its line leaves the pixel on this side of the nearer end
    tied = 8,         ///< a comparison was of equal numbers: `before`, `after` and `bends` are not valid
  };
  std::uint8_t *before, *after;  ///< distances of the ends, in half pixels
  std::uint8_t* flags;
  std::uint8_t* range;        ///< of the five lumas
  std::uint16_t* unlikeness;  ///< 12 × the difference of the luma and the weighed mean of its eight neighbours
};

struct FxaaKernels {
  /// Luma codes, (299 R + 587 G + 114 B) / 1000 rounded, of n pixels of four codes.
  void (*luma_row)(const std::uint8_t* rgba, std::uint8_t* luma, std::size_t n);
  /// Bit x of `bits` says that the contrast between pixel x of a row of luma and its four neighbours is to be treated.
  ///
  /// Shape     reads whole vectors: up to 31 values after the n-th; `bits` has room for n rounded up to 64.
  void (*contrast_row)(const std::uint8_t* luma, std::ptrdiff_t stride, FxaaContrast contrast, std::uint8_t* bits,
                       std::size_t n);
  /// Searches along the edges of the pixels whose bit is set; for others nothing valid is written.
  ///
  /// Shape     `distances` are where the search looks, in half pixels, and the last one is taken without looking; reads
  ///           and writes whole vectors, so that the arrays have room for n rounded up to 64.
  void (*ends_row)(const std::uint8_t* luma, std::ptrdiff_t stride, const int* distances, std::size_t count,
                   const std::uint8_t* bits, const FxaaEnds& ends, std::size_t n);
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

namespace antialias {

/// How far across an edge a pixel's colour is fetched, where FxaaEnds::tied: rounding decides what is equal, as if
/// lumas were doubles code / 255.
float fxaa_tied_shift(const std::uint8_t* pixel, std::ptrdiff_t along, std::ptrdiff_t across, const int* distances,
                      std::size_t count);

}  // namespace antialias
}  // namespace zoneplate
