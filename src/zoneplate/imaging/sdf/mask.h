// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/imaging/sdf/show_field.h"
#include "zoneplate/imaging/signal/result.h"

namespace zoneplate {

struct MaskOptions : SignalOptions {
  double threshold = 0.5, scale = 1;
  bool uses_alpha = false, is_inverted = false;
  FieldViewArgs view;
};

/// Makes the distance field of an image's bright pixels.
void make_field_of_mask(const std::string& input, const MaskOptions& args, Delivery& out);

/// Draws a stored distance field.
void draw_mask_of_field(const std::string& input, const MaskOptions& args, Delivery& out);

}  // namespace zoneplate
