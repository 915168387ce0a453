// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/plane.h"
#include "zoneplate/math/random.h"

namespace zoneplate {

/// Random values in [0, 1).
inline Plane<float> noise_plane(int width, int height) {
  Plane<float> plane(width, height);
  for (std::uint32_t i = 0; float& v : plane.values()) v = unit_float(hash(i++));
  return plane;
}

}  // namespace zoneplate
