// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The camera that shows all of a scene in the given direction, as near as the margin allows.
///
/// It is `fit_camera` of the vertices that lie farthest to each side, seen at the field of view and at fractions of it.
///
/// Exact     the tightest side touches the margin, as for all vertices; the other one is centred within 2% of the
///           image.
Camera fit_camera(const Scene& scene, float picture_aspect, const AutoFit& fit);

}  // namespace zoneplate
