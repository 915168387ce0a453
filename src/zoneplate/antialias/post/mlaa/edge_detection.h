// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/antialias/post/edge_stencil.h"
#include "zoneplate/base/isa.h"

namespace zoneplate {

struct MlaaKernels : PerIsa<MlaaKernels> {
  /// Sets bit 0 (left) and bit 1 (top) of `edges` if luma (RowKernels::luma) differs by at least `threshold` and by at
  /// least half of the greatest of the pixel's four differences.
  void (*luma_edges)(const EdgeRows<float>& rows, float threshold, std::uint8_t* edges, std::size_t n);
  /// Sets bit 0 of `edges` if red, green or blue of a pixel differ by at least `least` from the previous pixel (never
  /// at the first one), and bit 1 if they differ from the pixel above.
  ///
  /// Shape     rows of n pixels of four bytes; `least` is 16, 32, 64 or 128.
  void (*edges_row)(const std::uint8_t* above, const std::uint8_t* here, int least, std::uint8_t* edges, std::size_t n);
};

}  // namespace zoneplate
