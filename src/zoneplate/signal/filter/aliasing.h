// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/plane.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate {

/// The zone plate ½ + ½ cos(π r² / size), r in pixels from the plane's centre: its frequency grows with the distance,
/// r / size cycles per pixel, and reaches the Nyquist frequency in x and in y at the plane's edges, not beyond.
Plane<float> zone_plate(int size);

/// How much a kernel lets through, when an image is made smaller, of what the smaller image cannot hold.
///
/// The image is split by its spectrum into the part that the new grid holds (in x and in y below the new Nyquist
/// frequency) and the rest. Resampling is linear: the resampled rest is the alias, all of it and nothing else. Levels
/// are of its energy against the energy that it has when the image is sampled without a filter.
struct AliasFigures {
  double all_db = 0;   ///< all that aliases
  double far_db = 0;   ///< what comes from 1.5 times the new Nyquist frequency and beyond, in x or in y
  double pass_db = 0;  ///< error of the part that the grid holds against the ideal result, over its energy (no mean)
  double pass_half_db = 0;  ///< the same for frequencies below half of the new Nyquist frequency
};

/// Measured, border wrapped around.
AliasFigures measure_aliases(const Plane<float>& plane, int width, int height, const Kernel& kernel);

/// The same from the response of the kernel's weights alone (their mean over the phases in which they fall on the
/// input's pixels), for an image with a flat spectrum that is made smaller by `factor`.
AliasFigures predict_aliases(const Kernel& kernel, double factor);

}  // namespace zoneplate
