// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/sdf/draw.h"

namespace zoneplate {

/// How a distance field becomes an image.
enum class FieldView {
  Field,     ///< blue inside, orange outside, darker farther away, with isolines
  Isolines,  ///< isolines on white; the boundary is thick, inner lines are blue, outer ones orange
  Gradient,  ///< red is ½ + ½ x and green ½ + ½ y of the gradient
};

/// Lines are one pixel wide, antialiased by the field's gradient.
///
/// Units     distances and `spacing`, that of the isolines, in the field's unit; `scale` is its pixels per unit.
Rgba8Image show_field(const sdf::DistanceField& field, FieldView view, double spacing, double scale);

/// How a field is shown, as options set it.
struct FieldViewArgs {
  FieldView view = FieldView::Field;
  double spacing = 10;  ///< between isolines, in the field's unit
};

/// Black where coverage is 1 on white.
Rgba8Image black_on_white(const Plane<float>& coverage);

}  // namespace zoneplate
