// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/antialias/post/edge_stencil.h"
#include "zoneplate/base/isa.h"

namespace zoneplate {

struct MlaaKernels : PerIsa<MlaaKernels> {
  /// Bit 0 of `edges`: left, bit 1: top: where luma (RowKernels::luma) differs by `threshold` at least and by half
  /// of the greatest of the pixel's four differences.
  void (*luma_edges)(const EdgeRows<float>& rows, float threshold, std::uint8_t* edges, std::size_t n);
  /// Where red, green or blue of a pixel differ by `least` at least from those before it (bit 0 of `edges`; never at
  /// the first pixel) and above it (bit 1).
  ///
  /// Shape     rows of n pixels of four codes; `least` is 16, 32, 64 or 128.
  void (*edges_row)(const std::uint8_t* above, const std::uint8_t* here, int least, std::uint8_t* edges, std::size_t n);
};

}  // namespace zoneplate
