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
  /// Input pixels from one output pixel to the next; 0: the input's size over the output's.
  double step_x = 0, step_y = 0;
  /// The offset of the output grid to the right and downwards, in input pixels.
  double shift_x = 0, shift_y = 0;
};

/// The image on another grid, by any factor: the kernel interpolates, and where the grid becomes coarser it is
/// stretched by the factor, so that it also removes frequencies above the new Nyquist limit.
///
/// The centre of output pixel i lies at (i + ½) step - ½ among the centres of the input's pixels: no shift by half a
/// pixel. The weights of each output pixel are divided by their sum; with Border::Cut by the sum of those that meet
/// pixels, as Pillow does. A kernel that jumps has the mean of both sides where a pixel lies at its jump (Pillow: the
/// value of one side). Linear light, premultiplied; nothing is clamped,
/// so that kernels with negative lobes may go below 0 and above 1 at edges.
/// Requires  width, height >= 0; a plane without pixels gives zeros.
/// Exact     sums in double, rounded to float after each direction: a constant stays that constant to the bit. A ramp
///           stays a ramp, where no border is in reach, for kernels with linear precision (tent, b-spline,
///           catmull-rom, mitchell) and wherever the weights are symmetric; for the others the greatest error of place
///           is that of `place_error`. The same bits on every instruction set and number of threads.
/// Cost      2 ⌈radius × max(1, factor)⌉ products an output pixel and direction.
Plane<float> resample(const Plane<float>& plane, int width, int height, const Kernel& kernel,
                      const ResampleOptions& options = {});
LinearImage resample(const LinearImage& image, int width, int height, const Kernel& kernel,
                     const ResampleOptions& options = {});

/// The pixel in which each output pixel's centre falls (to the right and below on a tie): no filter at all.
Plane<float> resample_nearest(const Plane<float>& plane, int width, int height);
LinearImage resample_nearest(const LinearImage& image, int width, int height);

/// The ideal band-limited result for a periodic plane: all frequencies that both grids hold, unchanged, and no other.
///
/// A frequency of exactly half the sampling rate of the coarser grid is left out, unless the size stays the same.
Plane<float> resample_ideal(const Plane<float>& plane, int width, int height);

/// The weights of one output pixel at `centre`, for input pixels first, first + 1, ...; their sum is 1.
struct PixelWeights {
  int first = 0;
  std::vector<double> weights;
};
PixelWeights pixel_weights(const Kernel& kernel, double centre, double stretch);

/// The greatest |Σ w_j j - centre| over all phases, in output pixels: how far a ramp is bent.
double place_error(const Kernel& kernel, double step);

}  // namespace zoneplate
