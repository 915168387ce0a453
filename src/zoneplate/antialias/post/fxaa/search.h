// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

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
  };
  std::uint8_t* flags;
  float* shift;             ///< how far across the edge the colour is fetched
  std::uint8_t* tied_bits;  ///< where a comparison was of equal numbers: `shift` is that of the pixel by itself alone
};

/// What a search is given.
struct FxaaSearch {
  const int* distances;  ///< where it looks, in half pixels; the last is taken without looking
  std::size_t count;
  float subpixel;  ///< how much a pixel unlike its neighbours is taken towards them
};

struct FxaaKernels : PerIsa<FxaaKernels> {
  /// Luma codes, (299 R + 587 G + 114 B) / 1000 rounded, of n pixels of four codes.
  void (*luma_row)(const std::uint8_t* rgba, std::uint8_t* luma, std::size_t n);
  /// The green codes of n pixels.
  void (*green_row)(const std::uint8_t* rgba, std::uint8_t* green, std::size_t n);
  /// Bit x of `bits` says that the contrast between pixel x of a row of luma and its four neighbours is to be treated.
  ///
  /// Shape     reads whole vectors: up to 31 values after the n-th; `bits` has room for n rounded up to 64.
  void (*contrast_row)(const std::uint8_t* luma, std::ptrdiff_t stride, FxaaContrast contrast, std::uint8_t* bits,
                       std::size_t n);
  /// Searches along the edges of the pixels whose bit is set; for others nothing valid is written.
  ///
  /// Shape     reads and writes whole vectors, so that the arrays have room for n rounded up to 64; bits beyond the
  ///           n-th are clear.
  void (*ends_row)(const std::uint8_t* luma, std::ptrdiff_t stride, const FxaaSearch& search, const std::uint8_t* bits,
                   const FxaaEnds& ends, std::size_t n);
  /// Mixes the codes of the pixels whose bit is set with those across their edges, out of the row and those above and
  /// below it. Bits as above.
  void (*mix_row)(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                  const std::uint8_t* bits, const FxaaEnds& ends, std::uint8_t* out, std::size_t n);
};

namespace antialias {

/// How far across an edge a pixel's colour is fetched, where FxaaEnds::tied: rounding decides what is equal, as if
/// lumas were doubles code / 255.
float fxaa_tied_shift(const std::uint8_t* pixel, std::ptrdiff_t along, std::ptrdiff_t across, const int* distances,
                      std::size_t count);

}  // namespace antialias
}  // namespace zoneplate
