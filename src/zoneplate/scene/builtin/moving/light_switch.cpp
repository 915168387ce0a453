// SPDX-License-Identifier: Apache-2.0
// Balls at rest under a light that is switched on and off, and a lamp that a board covers.
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/builtin/moving/moving.h"

namespace zoneplate {
namespace light_switch_scene {
namespace {

Scene make(std::span<const std::int64_t> values) {
  const float time = moment_of(values);
  Scene scene = *make_builtin_scene("sphere:triangles=3000");
  const Box box = scene.bounds();
  const float radius = box.size().y / 2;
  scene.instances[0].world_from_object =
      scaling(float3{0.5f / radius, 0.5f / radius, 0.5f / radius}) * translation(-box.centre());
  add_part(scene, lit("wall", {1, 1, 1}), make_squares(0.2f, -4));
  Mesh lamp, board;
  add_disc(lamp, {0.85f, 0.55f, 1}, 0.12f);
  add_quad(board, {{-0.25f, -0.3f, 2}, {0.25f, -0.3f, 2}, {0.25f, 0.3f, 2}, {-0.25f, 0.3f, 2}});
  add_part(scene, unlit("lamp", {6, 5, 4}), std::move(lamp));
  add_part(scene, unlit("board", {0.06f, 0.05f, 0.05f}), std::move(board));
  scene.instances.back().world_from_object = translation(float3{0.2f + 0.45f * time, 0.55f, 0});
  const bool is_on = static_cast<int>(time * 2 + 1e-3f) % 2 == 0;
  Light key, fill;
  key.direction = normalize(float3{-0.5f, -0.6f, -0.7f}), key.intensity = is_on ? 2.5f : 0;
  fill.direction = normalize(float3{0.6f, -0.2f, -0.7f}), fill.intensity = 0.4f;
  scene.lights = {key, fill};
  add_motion(scene, flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace light_switch_scene

BuiltinMaker builtin_light_switch() {
  return {"light-switch", "a ball under a light that is switched twice a second, and a lamp that a board covers",
          moment_params, light_switch_scene::make};
}

}  // namespace zoneplate
