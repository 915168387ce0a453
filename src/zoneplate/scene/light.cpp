// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/light.h"

namespace zoneplate {

Light in_world_space(Light light, const float4x4& world_from_camera) {
  if (!light.is_in_camera_space) return light;
  light.is_in_camera_space = false;
  light.position = transform_point(world_from_camera, light.position);
  light.direction = normalize(transform_vector(world_from_camera, light.direction), {0, -1, 0});
  return light;
}

}  // namespace zoneplate
