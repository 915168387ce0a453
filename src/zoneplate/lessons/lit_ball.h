// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/scene.h"

namespace zoneplate::lessons {

/// A unit sphere of `columns` × `rows` quads with exact normals at its vertices, under one directional light from the
/// upper left, with a camera that shows all of it.
Scene lit_ball(const Material& material, int columns, int rows);

}  // namespace zoneplate::lessons
