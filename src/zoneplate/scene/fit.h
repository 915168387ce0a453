// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The camera that contains a whole scene in the given direction, as close as the margin allows.
///
/// It is `fit_camera` of the farthest vertices on each side, for the slopes of the field of view and fractions of them.
///
/// Exact     the tightest side touches the margin, as for all vertices; the other one is centred within 2% of the
///           image.
Camera fit_camera(const Scene& scene, float picture_aspect, const AutoFit& fit);

}  // namespace zoneplate
