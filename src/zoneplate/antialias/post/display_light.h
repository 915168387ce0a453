#pragma once

#include <optional>

#include "zoneplate/image/tonemap.h"

namespace zoneplate::antialias {

/// Which of two truths a filter makes of colours beyond white.
enum class FilterOrder {
  Scene,    ///< what is filtered is light, and the mean is tone mapped
  Display,  ///< each colour is tone mapped, and what is filtered is the light that the display sends
};

/// Light as it comes from the display, before it is encoded: exposed, tone mapped, in [0, 1].
class DisplayLight {
 public:
  explicit DisplayLight(const DisplayOptions& options) : options_(options) {}
  /// Premultiplied in, premultiplied out.
  Linear operator()(Linear color) const;

 private:
  DisplayOptions options_;
};

/// The picture of light that is tone mapped already.
DisplayImage encode_display_light(const LinearImage& image, DisplayOptions options);

}  // namespace zoneplate::antialias
