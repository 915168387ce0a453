// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

// With the border rule `zero`, pixels outside the image are black but not transparent: colour is filtered with `zero`,
// alpha with `clamp`.

inline Plane<float> alpha_of(const LinearImage& image) {
  Plane<float> out(image.width(), image.height());
  std::ranges::transform(image.values(), out.values().begin(), &Linear::a);
  return out;
}

/// Requires  equal sizes.
inline void set_alpha(LinearImage& image, const Plane<float>& alpha) {
  for (std::size_t i = 0; i < image.values().size(); ++i) image.values()[i].a = alpha.values()[i];
}

}  // namespace zoneplate
