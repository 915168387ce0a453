#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::metrics {

/// A picture as metrics see it: the same picture as codes and as light.
struct Picture {
  DisplayImage display;  ///< straight alpha
  LinearImage linear;    ///< premultiplied

  int width() const { return display.width(); }
  int height() const { return display.height(); }
};

/// The picture of display codes; its light is what they decode to.
Picture make_picture(DisplayImage display);

/// The picture of linear light; its codes are what a screen shows of it: clamped, without tone mapping.
Picture make_picture(LinearImage linear);

/// The codes of a picture that lies on black: each code times alpha. Metrics that do not speak of alpha judge this.
struct Codes {
  double r = 0, g = 0, b = 0;
};
constexpr Codes codes_on_black(Display c) {
  const double alpha = c.a;
  return {c.r * alpha, c.g * alpha, c.b * alpha};
}

/// Rec.709 luma: the weighted sum of codes (not of light).
constexpr double luma(Codes c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

/// The luma of every pixel of a picture on black.
Plane<double> luma_plane(const DisplayImage& image);

/// Rec.709 luminance of every pixel of a picture on black, in linear light.
Plane<double> luminance_plane(const LinearImage& image);

}  // namespace zoneplate::metrics
