// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::metrics {

/// The colour map magma: black through purple and orange to pale yellow, rising evenly in lightness.
///
/// Edges     values outside [0, 1] (and NaN) count as 0 or 1.
/// Source    van der Walt and Smith, A Better Default Colormap for Matplotlib, SciPy 2015; the table is CC0.
Rgba8 magma(float value);

/// An error map as a image.
Rgba8Image paint_magma(const Plane<float>& map);

}  // namespace zoneplate::metrics
