// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/antialias/post/edge_stencil.h"
#include "zoneplate/base/isa.h"

namespace zoneplate {

/// Minimum differences at an edge: for borders across which the predication buffer does not change, and across which it
/// does.
template <class T>
struct PredicatedThreshold {
  T plain, crossed;
};

struct SmaaKernels : PerIsa<SmaaKernels> {
  /// Sets bit 0 (left) and bit 1 (top) of `edges` by luma, with local contrast adaptation.
  void (*luma_edges)(const EdgeRows<float>& rows, float threshold, std::uint8_t* edges, std::size_t n);
  /// Sets the edges by the greatest difference of red, green and blue codes.
  void (*color_edges)(const EdgeRows<std::uint32_t>& rows, std::uint32_t threshold, std::uint8_t* edges, std::size_t n);
  /// Sets the edges with a threshold for each border. On entry, `edges` has the borders across which the predication
  /// buffer changes.
  void (*predicated_luma_edges)(const EdgeRows<float>& rows, PredicatedThreshold<float> threshold, std::uint8_t* edges,
                                std::size_t n);
  void (*predicated_color_edges)(const EdgeRows<std::uint32_t>& rows, PredicatedThreshold<std::uint32_t> threshold,
                                 std::uint8_t* edges, std::size_t n);
};

}  // namespace zoneplate
