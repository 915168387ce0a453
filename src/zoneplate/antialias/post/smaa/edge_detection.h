// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/antialias/post/edge_stencil.h"
#include "zoneplate/base/isa.h"

namespace zoneplate {

/// Least differences that are edges: of a border that the predication buffer does not cross, and of one that it does.
template <class T>
struct PredicatedThreshold {
  T plain, crossed;
};

struct SmaaKernels : PerIsa<SmaaKernels> {
  /// Bit 0 of `edges`: left, bit 1: top, by luma; with local contrast adaptation.
  void (*luma_edges)(const EdgeRows<float>& rows, float threshold, std::uint8_t* edges, std::size_t n);
  /// The same by the greatest difference of red, green and blue codes.
  void (*color_edges)(const EdgeRows<std::uint32_t>& rows, std::uint32_t threshold, std::uint8_t* edges, std::size_t n);
  /// The same with a threshold for each border. Before, `edges` holds the borders that the predication buffer crosses.
  void (*predicated_luma_edges)(const EdgeRows<float>& rows, PredicatedThreshold<float> threshold, std::uint8_t* edges,
                                std::size_t n);
  void (*predicated_color_edges)(const EdgeRows<std::uint32_t>& rows, PredicatedThreshold<std::uint32_t> threshold,
                                 std::uint8_t* edges, std::size_t n);
};

}  // namespace zoneplate
