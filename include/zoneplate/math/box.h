#pragma once

#include <algorithm>
#include <limits>

#include "zoneplate/base/api.h"
#include "zoneplate/math/mat.h"

namespace ZONEPLATE_API zoneplate {

/// An axis-aligned box; empty (low > high) until something is added.
struct Box {
  float3 low{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
             std::numeric_limits<float>::infinity()};
  float3 high{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
              -std::numeric_limits<float>::infinity()};

  bool empty() const { return low.x > high.x; }
  float3 centre() const { return (low + high) * 0.5f; }
  float3 size() const { return high - low; }
  /// The eight corners, i in [0, 8): bit 0 chooses x, bit 1 y, bit 2 z.
  float3 corner(int i) const { return {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z}; }

  void add(float3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const Box& b) {
    if (!b.empty()) add(b.low), add(b.high);
  }
};

}  // namespace zoneplate
