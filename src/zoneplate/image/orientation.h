// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "zoneplate/image/plane.h"

namespace zoneplate {

/// True for an Exif orientation whose image is shown with its stored rows as columns.
constexpr bool swaps_sides(int orientation) { return orientation >= 5 && orientation <= 8; }

/// The image as it is shown, of one that is stored with an Exif orientation from 1 to 8.
///
/// Source    Exif 2.32, tag 0x0112: 2 is mirrored, 3 turned by half, 4 upside down, 5 transposed, 6 is shown a quarter
///           turn clockwise, 7 transposed along the other diagonal, 8 a quarter turn counter-clockwise.
template <class T>
Plane<T> oriented(Plane<T> stored, int orientation) {
  if (orientation <= 1 || orientation > 8) return stored;
  const int width = stored.width(), height = stored.height();
  const bool swaps = swaps_sides(orientation);
  const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool from_bottom = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  Plane<T> out = Plane<T>::unset(swaps ? height : width, swaps ? width : height);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int u = swaps ? y : x, v = swaps ? x : y;
      out(x, y) = stored(from_right ? width - 1 - u : u, from_bottom ? height - 1 - v : v);
    }
  return out;
}

}  // namespace zoneplate
