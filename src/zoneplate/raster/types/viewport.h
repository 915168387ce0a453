// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate {

/// The size of the whole image. A crop does not change it, so that a crop has the bits of the whole image.
struct Viewport {
  int width = 0, height = 0;  ///< pixels, in [1, 32768]
};

}  // namespace zoneplate
