// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/default_lights.h"

namespace zoneplate {
namespace {

// The position of each light relative to the camera (x right, y up, z towards the viewer), and its illuminance.
struct Lamp {
  const char* name;
  float3 from;
  float lux;
};
constexpr Lamp lamps[] = {
    {"key", {-0.45f, 0.55f, 0.85f}, 2.2f}, {"fill", {0.9f, -0.15f, 0.6f}, 0.4f}, {"back", {0.2f, 0.8f, -0.7f}, 0.7f}};

}  // namespace

std::vector<Light> default_lights() {
  std::vector<Light> lights;
  for (const Lamp& lamp : lamps) {
    Light& light = lights.emplace_back();
    light.name = lamp.name;
    light.intensity = lamp.lux;
    light.is_in_camera_space = true;
    light.direction = -lamp.from;
  }
  return lights;
}

}  // namespace zoneplate
