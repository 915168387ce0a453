// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate::metrics {

/// Three numbers of one colour: linear RGB, XYZ, YCxCz or Lab as the function says.
struct Triple {
  double x = 0, y = 0, z = 0;
};

/// The colour spaces of FLIP. XYZ is of Rec.709 primaries; the white is theirs.
Triple xyz_from_rgb(Triple rgb);
Triple rgb_from_xyz(Triple xyz);

/// YCxCz, the linear opponent space in which contrast sensitivity is applied.
Triple opponent_from_rgb(Triple rgb);
Triple rgb_from_opponent(Triple opponent);

/// CIELAB with its chroma scaled by lightness (Hunt: colours look fuller in more light).
Triple hunt_lab_from_rgb(Triple rgb);

/// HyAB, the distance of large colour differences: city block between lightness and chroma.
///
/// Source    Abasi, Tehran, Fairchild, Distance Metrics for Very Large Color Differences, CR&A 2019.
double hyab(Triple a, Triple b);

}  // namespace zoneplate::metrics
