// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/plane.h"

namespace zoneplate {

/// A plane as the sum of a part whose opposite edges match and a smooth part that contains the jumps between them.
///
/// The spectrum of the periodic part has no cross through the origin, and needs no window, which would suppress the
/// borders. The smooth part is the mean-free solution of the periodic Poisson equation whose source is the jump across
/// each edge.
///
/// Exact     periodic + smooth is the plane within 1 unit in the last place.
/// Cost      one forward and one inverse transform.
/// Source    Moisan, Periodic plus Smooth Image Decomposition, J. Mathematical Imaging and Vision 39, 2011.
struct PeriodicSmooth {
  Plane<float> periodic, smooth;
};
PeriodicSmooth split_periodic_smooth(const Plane<float>& plane);

}  // namespace zoneplate
