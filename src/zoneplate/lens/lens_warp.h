// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/scene/camera.h"

namespace zoneplate {

/// A direction from the eye as the point at which it meets the plane at distance 1: x to the right, y downwards.
struct LensPoint {
  double x = 0, y = 0;
};

/// Where the lens shows a direction: OpenCV's model of `Lens`.
LensPoint distorted(const Lens& lens, LensPoint undistorted);

/// The direction that the lens shows there, by Newton's method to the last bits; nothing where it does not converge, or
/// where the model is folded.
std::optional<LensPoint> undistorted(const Lens& lens, LensPoint distorted);

/// The lens in an image of another size, in its pixels: its own image is centred and touches two sides.
Lens scaled_to(const Lens& lens, int width, int height);

/// Resamples an image without distortion as one through a lens.
///
/// The frame without distortion contains the whole view, and has at least two of its pixels for each of the image along
/// every direction. A pixel of the image is the mean of the frame's pixels under a tent of the radius of one pixel of
/// the image, mapped to the frame by the derivative of the lens at its centre: in linear light, premultiplied.
/// Exact     the same bits for any number of threads; a part has the bits of the whole.
/// Errors    the constructor throws ErrorKind::Usage where the distortion has no inverse within the image, or the frame
///           would have more than 32768 pixels a side.
/// Source    warping by a pixel's footprint: Greene and Heckbert, Creating Raster Omnimax Images Using the Elliptically
///           Weighted Average Filter, IEEE CG&A 1986, here with a separable tent.
class LensWarp {
 public:
  /// For the pixels [x, x + part_width) × [y, y + part_height) of an image.
  LensWarp(const Lens& lens, int width, int height, int x, int y, int part_width, int part_height);

  /// The frame's lens, without distortion; its size is that of the whole frame.
  const Lens& frame() const { return frame_; }
  /// The part of the frame that is read: x, y, width and height.
  struct Part {
    int x = 0, y = 0, width = 0, height = 0;
  };
  const Part& frame_part() const { return part_; }
  /// Pixels of the frame for one of the image, where the lens does not distort.
  double scale() const { return scale_; }

  /// The part of the image; `image` is the frame's part.
  LinearImage warped(const LinearImage& image) const;
  /// The same for display-referred values, which are decoded and encoded again.
  DisplayImage warped(const Rgba16Image& image, bool is_raw) const;
  /// The frame's pixels at the centres of the image's.
  template <class T>
  Plane<T> nearest(const Plane<T>& frame) const {
    if (frame.empty()) return {};
    Plane<T> out(width_, height_);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) out(x, y) = frame(column(x, y), row(x, y));
    return out;
  }
  /// Steps of surface points in the frame, from `begin` times the step before a pixel to `end` times the step after it,
  /// as steps in the image.
  Plane<float2> nearest_steps(const Plane<float2>& frame, float begin, float end) const;

 private:
  /// Of a pixel: its centre's position in the frame, and the derivative of that along x and y of the image.
  struct Footprint {
    float x, y;
    float xx, xy, yx, yy;
  };
  const Footprint& at(int x, int y) const {
    return footprints_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  }
  int column(int x, int y) const;
  int row(int x, int y) const;
  Footprint footprint(double x, double y) const;
  LensPoint in_image(double x, double y) const;

  Lens lens_;   ///< in pixels of the image
  Lens frame_;  ///< in pixels of the frame
  double scale_ = 1;
  int width_, height_;  ///< of the image's part
  Part part_;
  std::vector<Footprint> footprints_;
};

}  // namespace zoneplate
