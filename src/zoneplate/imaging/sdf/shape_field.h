// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/imaging/sdf/shape_scene.h"
#include "zoneplate/imaging/sdf/show_field.h"

namespace zoneplate {

struct ShapeFieldOptions : ShapeSceneOptions {
  FieldViewArgs view;
};

/// Shows or stores the distances of a scene of shapes.
void save_shape_field(const std::string& input, const ShapeFieldOptions& args, Delivery& out);

}  // namespace zoneplate
