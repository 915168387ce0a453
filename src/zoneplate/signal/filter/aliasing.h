// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/plane.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate {

/// The zone plate ½ + ½ cos(π r² / size), r in pixels from the plane's centre: its frequency is r / size cycles per
/// pixel, and reaches the Nyquist frequency in x and in y exactly at the plane's edges.
Plane<float> zone_plate(int size);

/// The amount of aliasing of a kernel in minification.
///
/// The spectrum of the image is split into the part that the new grid can represent (below the new Nyquist frequency in
/// x and in y) and the rest. Resampling is linear, so that the resampled rest is exactly the alias. Levels are relative
/// to the energy of the alias without a filter.
struct AliasFigures {
  double all_db = 0;  ///< the energy of all aliases
  /// The energy of aliases from frequencies above 1.5 times the new Nyquist frequency, in x or in y.
  double far_db = 0;
  /// Error of the representable part relative to the ideal result, over its energy (without the mean).
  double pass_db = 0;
  double pass_half_db = 0;  ///< the same for frequencies below half of the new Nyquist frequency
};

/// Measures the aliasing of an image; the border is wrapped around.
AliasFigures measure_aliases(const Plane<float>& plane, int width, int height, const Kernel& kernel);

/// Predicts the aliasing of minification by `factor` for an image with a flat spectrum, from the response of the
/// kernel's weights (the mean over the phases at which they are sampled by input pixels).
AliasFigures predict_aliases(const Kernel& kernel, double factor);

}  // namespace zoneplate
