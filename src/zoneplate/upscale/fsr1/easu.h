// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

/// How reciprocals and reciprocal roots are computed.
enum class Reciprocals {
  Approximate,  ///< by subtraction from the bits of the float, as AMD's shaders do: off by up to 12 %
  Exact,        ///< correctly rounded, as three.js does
};

/// The input of one output row of EASU.
///
/// Pixels have four floats, all rows are those of the input, and `columns` has the index of each output pixel's tap in
/// its row.
struct EasuRow {
  const float* rows[4];            ///< pixels of the rows y - 1 to y + 2, where y is the row above the output's centre
  const float* edges[2];           ///< edges of rows y and y + 1: four floats per pixel, column -1 first
  const std::int32_t* columns[4];  ///< in floats, of the columns x - 1 to x + 2, clamped to the input
  const std::int32_t* edge;        ///< in floats, of column x in `edges`
  const float* right;              ///< distance of the output's centre from column x, in [0, 1)
  float below;                     ///< the same from row y
};

/// The operations of FSR 1's upscaling pass, edge-adaptive spatial upsampling.
///
/// Exact     the same bits on every instruction set.
/// Source    AMD, FidelityFX Super Resolution 1.0, ffx_fsr1.h: FsrEasuF.
struct EasuKernels : PerIsa<EasuKernels> {
  /// Twice the luma of n pixels: red / 2 + green + blue / 2.
  void (*luma_row)(const float* pixels, float* luma, std::size_t n);
  /// The edge at n pixels, from lumas that are valid from one before the first to one after the last: the gradient
  /// along x and y, and its length, 0 where the gradient reverses (a line) to 2 where it is monotonic along both axes.
  /// The fourth value is 0.
  void (*edge_row)(const float* above, const float* here, const float* below, Reciprocals reciprocals, float* edges,
                   std::size_t n);
  /// One row of n output pixels.
  void (*upscale_row)(const EasuRow& row, Reciprocals reciprocals, float* out, std::size_t n);
};

}  // namespace zoneplate
