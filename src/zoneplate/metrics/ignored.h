// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// Parts of images that are not measured.
struct IgnoredRegions {
  struct Rectangle {
    int x = 0, y = 0, width = 0, height = 0;  ///< in pixels; a part outside of the image has no effect
  };
  std::vector<Rectangle> rectangles;
  std::vector<std::pair<std::string, Picture>> masks;  ///< their names, and images whose light pixels are ignored

  bool empty() const { return rectangles.empty() && masks.empty(); }
};

/// Sets `is_ignored` of a reference; of no regions it is left empty.
///
/// A pixel of a mask is ignored if its luma over black is above one half.
/// Errors    ErrorKind::Input naming a mask of another size than the reference, or if no pixel remains.
void mark_ignored(Picture& reference, const IgnoredRegions& regions);

/// Gives the test image the pixels of the reference that are ignored, so that windows of metrics which reach into them
/// find no difference there; none of them counts as uncovered. Does nothing to images of different sizes.
void hide_ignored(Picture& reference, Picture& test);

/// Whether a pixel is measured.
inline bool is_measured(const Picture& reference, int x, int y) {
  return reference.is_ignored.empty() || reference.is_ignored(x, y) == 0;
}

/// The number of measured pixels, at least 1.
double measured_pixels(const Picture& reference);

}  // namespace zoneplate::metrics
