// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Edges as bytes, over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// Stores 1 if `first` plus 2 if `second`, one byte per lane.
template <class F>
[[gnu::always_inline]] inline void store_edges(typename F::Bool first, typename F::Bool second, std::uint8_t* edges) {
  using Int = typename F::Int;
  (where(first, Int(1)) | where(second, Int(2))).store_as(edges);
}

}  // namespace zoneplate::stages
