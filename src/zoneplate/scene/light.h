#pragma once

#include <limits>
#include <string>

#include "zoneplate/math/vec.h"

namespace zoneplate {

enum class LightKind { Directional, Point, Spot };

/// How a point or spot light fades with the distance d.
enum class Falloff {
  InverseSquare,  ///< 1 / d², times glTF's window when `range` is finite (KHR_lights_punctual)
  Quadratic,      ///< 1 / (a0 + a1 d + a2 d²)
};

/// A light of no extent, in world space.
///
/// Units     `color` linear; `intensity` in lux (directional) or candela (point, spot), as KHR_lights_punctual;
///           angles from the axis in radians.
struct Light {
  std::string name;
  LightKind kind = LightKind::Directional;
  float3 color{1, 1, 1};
  float intensity = 1;
  float3 position{0, 0, 0};
  float3 direction{0, 0, -1};  ///< the way the light travels, unit length
  float range = std::numeric_limits<float>::infinity();
  Falloff falloff = Falloff::InverseSquare;
  float3 attenuation{1, 0, 0};  ///< a0, a1, a2 of Falloff::Quadratic
  float inner_cone = 0, outer_cone = 0.7853982f;
};

}  // namespace zoneplate
