// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// Makes an image opaque if all of its pixels have alpha 0: programs that mean no alpha leave its bits 0.
inline void make_opaque_if_clear(Rgba8Image& image) {
  const auto values = image.values();
  if (std::any_of(values.begin(), values.end(), [](Rgba8 c) { return c.a != 0; })) return;
  for (Rgba8& c : image.values()) c.a = 255;
}

}  // namespace zoneplate
