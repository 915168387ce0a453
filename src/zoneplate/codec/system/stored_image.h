// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// A decoded image in the precision of its file.
struct StoredImage {
  /// Codes with straight alpha, or scene-linear light, premultiplied.
  std::variant<Rgba8Image, Rgba16Image, LinearImage> pixels;
  /// That of Exif and TIFF, 1 to 8: an image is turned by it where it is displayed, and not where it is a texture.
  int orientation = 1;
  /// The ICC profile of the codes where the header of the file does not state it (SystemFormat::find_colors); empty:
  /// none.
  std::vector<std::uint8_t> profile = {};
};

}  // namespace zoneplate
