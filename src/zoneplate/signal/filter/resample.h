// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/image/plane.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/signal/border.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate {

struct ResampleOptions {
  Border border = Border::Clamp;
  /// Distance of neighbouring output pixels in input pixels; 0: the input's size over the output's.
  double step_x = 0, step_y = 0;
  /// Offset of the output grid to the right and downwards, in input pixels.
  double shift_x = 0, shift_y = 0;
  /// Index of the first output pixel in the grid of the whole output, so that an image can be made in parts.
  int first_x = 0, first_y = 0;
};

/// Resamples an image on another grid, by any factor: the kernel interpolates. In minification it is stretched by the
/// factor, so that it also removes frequencies above the new Nyquist limit.
///
/// The centre of output pixel i is at shift + (first + i + ½) step - ½ among the centres of the input's pixels, so that
/// there is no shift by half a pixel. The weights of each output pixel are divided by their sum; with Border::Cut, by
/// the sum of those at pixels, as in Pillow. At a discontinuity of the kernel, a pixel gets the mean of both sides
/// (Pillow: the value of one side). Colours are linear and premultiplied. Nothing is clamped, so that with negative
/// lobes values near edges may be below 0 and above 1.
/// Requires  width, height >= 0; a plane without pixels gives zeros.
/// Exact     sums in double, rounded to float after each direction: a constant image is preserved to the bit. A ramp is
///           preserved, away from the border, by kernels with linear precision (tent, b-spline, catmull-rom, mitchell)
///           and wherever the weights are symmetric; for the others the greatest displacement is `place_error`. The
///           same bits on every instruction set and number of threads.
/// Cost      2 ⌈radius × max(1, factor)⌉ products per output pixel and direction.
Plane<float> resample(const Plane<float>& plane, int width, int height, const Kernel& kernel,
                      const ResampleOptions& options = {});
LinearImage resample(const LinearImage& image, int width, int height, const Kernel& kernel,
                     const ResampleOptions& options = {});

/// Resamples without a filter: takes the pixel that contains each output pixel's centre (the right or lower one on a
/// tie).
Plane<float> resample_nearest(const Plane<float>& plane, int width, int height);
LinearImage resample_nearest(const LinearImage& image, int width, int height);

/// The ideal band-limited result for a periodic plane: all frequencies that both grids represent, unchanged, and no
/// others.
///
/// A frequency of exactly half the sampling rate of the coarser grid is omitted, unless the size stays the same.
Plane<float> resample_ideal(const Plane<float>& plane, int width, int height);

/// The weights of one output pixel at `centre`, for input pixels first, first + 1, ...; their sum is 1.
struct PixelWeights {
  int first = 0;
  std::vector<double> weights;
};
PixelWeights pixel_weights(const Kernel& kernel, double centre, double stretch);

/// The greatest |Σ w_j j - centre| over all phases, in output pixels: the displacement of a ramp.
double place_error(const Kernel& kernel, double step);

}  // namespace zoneplate
