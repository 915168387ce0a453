#pragma once

#include <limits>
#include <string>

#include "zoneplate/math/mat.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

enum class LightKind { Directional, Point, Spot };

/// The attenuation of a point or spot light with the distance d.
enum class Falloff {
  InverseSquare,  ///< 1 / d², times glTF's window when `range` is finite (KHR_lights_punctual)
  Quadratic,      ///< 1 / (a0 + a1 d + a2 d²)
};

/// A punctual light, in world space or fixed to the camera.
///
/// Units     `color` linear; `intensity` in lux (directional) or candela (point, spot), as KHR_lights_punctual;
///           angles from the axis in radians.
struct Light {
  std::string name;
  LightKind kind = LightKind::Directional;
  bool is_in_camera_space = false;  ///< `position` and `direction` are in the space of the rendering camera
  float3 color{1, 1, 1};
  float intensity = 1;
  float3 position{0, 0, 0};
  float3 direction{0, 0, -1};  ///< from the light; of unit length in world space
  float range = std::numeric_limits<float>::infinity();
  Falloff falloff = Falloff::InverseSquare;
  float3 attenuation{1, 0, 0};  ///< a0, a1, a2 of Falloff::Quadratic
  float inner_cone = 0, outer_cone = 0.7853982f;
};

/// The light in world space: a light in camera space is transformed by `world_from_camera`, others are unchanged.
Light in_world_space(Light light, const float4x4& world_from_camera);

}  // namespace zoneplate
