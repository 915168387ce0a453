// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// The mean over all pixels and the three colours of the squared difference of two images' encoded values.
///
/// Requires  equal sizes, at least one pixel.
/// Edges     transparent images are composited over black; symmetric; exactly 0 for equal values.
/// Units     squared display-referred values in [0, 1].
double mean_squared_error(const DisplayImage& reference, const DisplayImage& test);
/// The same over the pixels that are not ignored, of a test image that agrees with the reference in those that are
/// (hide_ignored).
double mean_squared_error(const Picture& reference, const Picture& test);

/// The root of each pixel's mean squared difference, in display-referred values.
Plane<float> squared_error_map(const DisplayImage& reference, const DisplayImage& test);

}  // namespace zoneplate::metrics
