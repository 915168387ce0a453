// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/imaging/sdf/shape_scene.h"

namespace zoneplate {

struct DrawShapesOptions : ShapeSceneOptions {
  int grid = 1;
  bool measures_error = false;
};

/// Draws a scene of shapes.
void draw_shapes(const std::string& input, const DrawShapesOptions& args, Delivery& out);

}  // namespace zoneplate
