// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"

namespace zoneplate::metrics {

/// The colour map magma: black through purple and orange to pale yellow, with uniformly increasing lightness.
///
/// Edges     values are clamped to [0, 1]; NaN counts as 0.
/// Source    van der Walt and Smith, A Better Default Colormap for Matplotlib, SciPy 2015; the table is CC0.
Rgba8 magma(float value);

/// An error map as an image.
Rgba8Image paint_magma(const Plane<float>& map);

}  // namespace zoneplate::metrics
