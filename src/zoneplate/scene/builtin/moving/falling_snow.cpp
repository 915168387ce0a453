// SPDX-License-Identifier: Apache-2.0
// Flakes smaller than a pixel, which fall before a dark wall.
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/builtin/moving/moving.h"

namespace zoneplate {
namespace falling_snow_scene {
namespace {

Mesh make_flakes(float time) {
  constexpr std::uint32_t flakes = 1200;
  constexpr float two_pi = 6.2831853f;
  Mesh mesh;
  for (std::uint32_t i = 0; i < flakes; ++i) {
    const auto random = [i](std::uint32_t which) { return unit_float(hash(i, which)); };
    const float half = (0.3f + 0.9f * random(1)) * pixel_side;  // 0.6 to 2.4 pixels wide
    const float speed = (40 + 80 * random(2)) * pixel_side;     // 1.7 to 5 pixels per frame
    const float drift = 6 * pixel_side * sin(two_pi * (0.5f * time + random(3)));
    const float x = 2.8f * random(4) - 1.4f + drift, y = 3.2f * random(5) - 1.1f - speed * time;
    const float z = -2 - random(6);
    add_quad(mesh,
             {{x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}});
  }
  return mesh;
}

Scene make(std::span<const std::int64_t> values) {
  Scene scene;
  Mesh wall;
  add_quad(wall, {{-2, -1.5f, -4}, {2, -1.5f, -4}, {2, 1.5f, -4}, {-2, 1.5f, -4}}, {0.02f, 0.03f, 0.05f},
           {0.06f, 0.10f, 0.18f});
  add_part(scene, unlit("wall", {1, 1, 1}), std::move(wall));
  add_part(scene, unlit("flakes", {0.9f, 0.92f, 0.95f}), make_flakes(moment_of(values)));
  add_motion(scene, flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace falling_snow_scene

BuiltinMaker builtin_falling_snow() {
  return {"falling-snow", "particles of half a pixel to two before a dark wall (godot pull request 111631)",
          moment_params, falling_snow_scene::make};
}

}  // namespace zoneplate
