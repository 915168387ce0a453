// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/image/plane.h"

namespace zoneplate::metrics {

/// Halves the size (rounded up), with the filter (0.05, 0.25, 0.4, 0.25, 0.05); the border is mirrored, its pixel
/// repeated.
///
/// Requires  at least 2 × 2.
Plane<double> reduce(const Plane<double>& in);

/// Doubles the size with the same filter; the size is 1 less if `width` or `height` is odd.
///
/// Requires  `in` is (width + 1) / 2 × (height + 1) / 2.
Plane<double> expand(const Plane<double>& in, int width, int height);

/// The peak frequencies of an image's bands, in cycles per degree, finest first; the last is that of the base band,
/// 0.1.
std::vector<double> band_frequencies(int width, int height, double pixels_per_degree);

}  // namespace zoneplate::metrics
