// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "zoneplate/image/rgb.h"

namespace zoneplate::antialias {

/// The least and the greatest value of each channel of some colours.
struct ColorRange {
  Display low{1, 1, 1, 1}, high{0, 0, 0, 0};

  /// Adds the colour of a pixel that is not entirely transparent.
  void add(const Display& c) {
    if (!(c.a > 0)) return;
    low = {std::min(low.r, c.r), std::min(low.g, c.g), std::min(low.b, c.b)};
    high = {std::max(high.r, c.r), std::max(high.g, c.g), std::max(high.b, c.b)};
  }
  bool empty() const { return low.r > high.r; }
  /// The nearest colour of the range, with the same alpha; the same colour if the range is empty.
  Display clamp(const Display& c) const {
    if (empty()) return c;
    return {std::clamp(c.r, low.r, high.r), std::clamp(c.g, low.g, high.g), std::clamp(c.b, low.b, high.b), c.a};
  }
};

}  // namespace zoneplate::antialias
