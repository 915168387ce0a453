// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/image/plane.h"

namespace zoneplate::metrics {

/// Half the size (rounded up), filtered by (0.05, 0.25, 0.4, 0.25, 0.05); the border is mirrored, its pixel twice.
///
/// Requires  at least 2 × 2.
Plane<double> reduce(const Plane<double>& in);

/// The inverse step, with the same filter: twice the size, less one if `width` or `height` is odd.
///
/// Requires  `in` is (width + 1) / 2 × (height + 1) / 2.
Plane<double> expand(const Plane<double>& in, int width, int height);

/// The frequencies at which the bands of an image peak, in cycles per degree, finest first; the last is that of
/// what is left below, 0.1.
std::vector<double> band_frequencies(int width, int height, double pixels_per_degree);

}  // namespace zoneplate::metrics
