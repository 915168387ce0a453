// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/base/isa.h"

namespace zoneplate {

struct Cmaa2Kernels : PerIsa<Cmaa2Kernels> {
  /// Edges of n pixels: bit 0 is set if the difference of luma to the right, bit 1 if that to the pixel below exceeds
  /// `threshold` by more than `contrast` times the greatest of the four borders adjacent to the ends of this border.
  ///
  /// Shape     rows[0] is the row above, rows[1] the row itself; valid from one value before the first to two after the
  ///           last.
  void (*edge_row)(const float* const (&rows)[4], float threshold, float contrast, std::uint8_t* edges, std::size_t n);
  /// All four borders of n pixels as bits (0 right, 1 below, 2 left, 3 above), from the edges of a row and the one
  /// above it; bit x of `bits` is set if pixel x has a corner.
  ///
  /// Shape     `edges` is valid from one value before the first; whole vectors are read and written: up to 31 values
  ///           after the n-th; `bits` has capacity for n rounded up to 64.
  void (*shape_row)(const std::uint8_t* edges, const std::uint8_t* above, std::uint8_t* shapes, std::uint8_t* bits,
                    std::size_t n);
};

}  // namespace zoneplate
