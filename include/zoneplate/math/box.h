// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>

#include "zoneplate/math/mat.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// An axis-aligned box; empty (low > high) until something is added.
struct Box {
  /// The corner of the least coordinates.
  float3 low{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
             std::numeric_limits<float>::infinity()};
  /// The corner of the greatest coordinates.
  float3 high{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
              -std::numeric_limits<float>::infinity()};

  /// True if nothing was added. A box of one point is not empty.
  bool empty() const { return low.x > high.x; }
  /// The midpoint.
  /// Requires  the box is not empty.
  float3 centre() const { return (low + high) * 0.5f; }
  /// The lengths of the edges along x, y and z.
  /// Requires  the box is not empty.
  float3 size() const { return high - low; }
  /// The eight corners, i in [0, 8): bit 0 chooses x, bit 1 y, bit 2 z.
  float3 corner(int i) const { return {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z}; }

  /// Grows the box so that it contains the point.
  void add(float3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  /// Grows the box so that it contains another box; an empty one adds nothing.
  void add(const Box& b) {
    if (!b.empty()) add(b.low), add(b.high);
  }
};

}  // namespace zoneplate
#pragma GCC visibility pop
