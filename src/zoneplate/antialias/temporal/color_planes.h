// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace zoneplate::antialias {

/// Colours by channel: every row has `width` values of red, then of green, blue and alpha. A vector of neighbouring
/// pixels is loaded without shuffling, wherever it begins, and the channels of a pixel do not compete for the same
/// lines of a cache, as those of four planes in pages of their own do.
template <class T>
struct ColorPlanes {
  T* red;  ///< of pixel 0 of a row
  std::ptrdiff_t width;

  T* channel(int c) const { return red + c * width; }
  /// The distance from a value to that of the pixel below.
  std::ptrdiff_t stride() const { return 4 * width; }
};

}  // namespace zoneplate::antialias
