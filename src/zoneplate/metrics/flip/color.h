// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate::metrics {

/// Three components of a colour: linear RGB, XYZ, YCxCz or Lab, depending on the function.
struct Triple {
  double x = 0, y = 0, z = 0;
};

/// The colour spaces of FLIP. XYZ is relative to Rec.709 primaries and their white.
Triple xyz_from_rgb(Triple rgb);
Triple rgb_from_xyz(Triple xyz);

/// YCxCz, the linear opponent space in which contrast sensitivity is applied.
Triple opponent_from_rgb(Triple rgb);
Triple rgb_from_opponent(Triple opponent);

/// CIELAB with its chroma scaled by lightness (Hunt effect: colours appear more saturated in brighter light).
Triple hunt_lab_from_rgb(Triple rgb);

/// HyAB, a metric for large colour differences: city-block distance between lightness and chroma.
///
/// Source    Abasi, Tehran, Fairchild, Distance Metrics for Very Large Color Differences, CR&A 2019.
double hyab(Triple a, Triple b);

}  // namespace zoneplate::metrics
