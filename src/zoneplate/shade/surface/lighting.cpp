// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/lighting.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/math/elementary.h"
#include "zoneplate/scene/light.h"
#include "zoneplate/shade/surface/components.h"

namespace zoneplate {
PreparedLight prepare(const Light& light) {
  PreparedLight p;
  p.is_directional = light.kind == LightKind::Directional;
  p.is_spot = light.kind == LightKind::Spot;
  p.is_quadratic = light.falloff == Falloff::Quadratic;
  copy(light.color * light.intensity, p.radiance);
  const float3 axis = normalize(light.direction, {0, 0, -1});
  copy(axis, p.axis);
  copy(-axis, p.towards);
  copy(light.position, p.position);
  copy(light.attenuation, p.attenuation);
  // Halfway vectors turn by half the angle of the light.
  const float half = (p.is_directional ? sin(light.radius) : light.radius) * 0.5f;
  p.spread = std::min(half * half, 1.0f);

  // Beyond 1e9 m the window's fourth power would underflow, and no image could show it.
  if (std::isfinite(light.range) && light.range < 1e9f) {
    const float range = std::max(light.range, 1e-6f);
    p.inverse_range4 = std::min(1 / (range * range * range * range), 1e24f);
  }
  if (p.is_spot) {
    const float outer = cos(light.outer_cone);
    p.cone_scale = 1 / std::max(0.001f, cos(light.inner_cone) - outer);
    p.cone_offset = -outer * p.cone_scale;
  }
  return p;
}

}  // namespace zoneplate
