// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>

#include "zoneplate/image/plane.h"
#include "zoneplate/render/frame.h"

namespace zoneplate {

/// The data of the nearest surface.
inline constexpr Planes surface_planes{.depth = true,
                                       .normal = true,
                                       .albedo = true,
                                       .uv = true,
                                       .object_id = true,
                                       .material_id = true,
                                       .primitive_id = true,
                                       .coverage = true,
                                       .position = true};

template <class T>
bool has_same_bytes(const Plane<T>& a, const Plane<T>& b) {
  return a.width() == b.width() && a.height() == b.height() &&
         std::ranges::equal(std::as_bytes(a.values()), std::as_bytes(b.values()));
}

}  // namespace zoneplate
