// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// The contrast up to which FXAA does nothing: the greater of `least` and factor / 65536 of the greatest luma.
struct FxaaContrast {
  std::uint8_t least = 0;
  std::uint16_t factor = 0;
};

/// The result of the search along edges for the pixels of a row: one array each.
struct FxaaEnds {
  enum : int {
    level = 1,        ///< the edge is horizontal
    second_side = 2,  ///< the edge is between the pixel and the one below or on the right
  };
  std::uint8_t* flags;
  float* shift;             ///< the distance across the edge at which the colour is fetched
  std::uint8_t* tied_bits;  ///< set if a comparison was tied: `shift` is then that of sub-pixel smoothing only
};

/// The parameters of a search.
struct FxaaSearch {
  const int* distances;  ///< the tested distances, in half pixels; the last one is used without a test
  std::size_t count;
  float subpixel;  ///< weight with which a pixel that differs from its neighbours is moved towards them
};

struct FxaaKernels : PerIsa<FxaaKernels> {
  /// Luma codes, (299 R + 587 G + 114 B) / 1000 rounded, of n pixels of four bytes.
  void (*luma_row)(const std::uint8_t* rgba, std::uint8_t* luma, std::size_t n);
  /// The green codes of n pixels.
  void (*green_row)(const std::uint8_t* rgba, std::uint8_t* green, std::size_t n);
  /// Sets bit x of `bits` if the contrast between pixel x of a row of luma and its four neighbours exceeds `contrast`.
  ///
  /// Shape     whole vectors are read: up to 31 values after the n-th; `bits` has capacity for n rounded up to 64.
  void (*contrast_row)(const std::uint8_t* luma, std::ptrdiff_t stride, FxaaContrast contrast, std::uint8_t* bits,
                       std::size_t n);
  /// Searches along the edges of the pixels whose bit is set; the results of other pixels are unspecified.
  ///
  /// Shape     whole vectors are read and written, so that the arrays have capacity for n rounded up to 64; bits beyond
  ///           the n-th are clear.
  void (*ends_row)(const std::uint8_t* luma, std::ptrdiff_t stride, const FxaaSearch& search, const std::uint8_t* bits,
                   const FxaaEnds& ends, std::size_t n);
  /// Blends the codes of the pixels whose bit is set with those across their edges, which are in the row or those above
  /// and below it. Bits are as above.
  void (*mix_row)(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                  const std::uint8_t* bits, const FxaaEnds& ends, std::uint8_t* out, std::size_t n);
};

namespace antialias {

/// The distance across an edge at which a pixel's colour is fetched, for FxaaEnds::tied_bits: ties are decided by
/// rounding, with lumas as doubles code / 255.
float fxaa_tied_shift(const std::uint8_t* pixel, std::ptrdiff_t along, std::ptrdiff_t across, const int* distances,
                      std::size_t count);

}  // namespace antialias
}  // namespace zoneplate
