#pragma once

namespace zoneplate {

/// The whole picture's size; a crop does not change it, so that a crop has the whole picture's bits.
struct Viewport {
  int width = 0, height = 0;  ///< pixels, in [1, 32768]
};

}  // namespace zoneplate
