// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "zoneplate/image/tonemap.h"

namespace zoneplate::antialias {

/// The order of filtering and tone mapping, which matters for colours brighter than white.
enum class FilterOrder {
  Scene,    ///< filter in scene-linear light, then tone-map the mean
  Display,  ///< tone-map each colour, then filter display-linear light
};

/// Converts scene-linear colours to display-linear light: exposed and tone-mapped to [0, 1], not encoded.
class DisplayLight {
 public:
  explicit DisplayLight(const DisplayOptions& options) : options_(options) {}
  /// Argument and result are premultiplied.
  Linear operator()(Linear color) const;

 private:
  DisplayOptions options_;
};

/// Encodes an image of display-linear light.
DisplayImage encode_display_light(const LinearImage& image, DisplayOptions options);

}  // namespace zoneplate::antialias
