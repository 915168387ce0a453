// SPDX-License-Identifier: Apache-2.0
// A slab that slides over a wall of small squares and uncovers it.
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/moving/moving.h"

namespace zoneplate {
namespace disocclusion_scene {
namespace {

Scene make(std::span<const std::int64_t> values) {
  constexpr float speed = 140 * pixel_side;  // 5.8 pixels per frame
  Scene scene;
  add_part(scene, unlit("wall", {1, 1, 1}), make_squares(5 * pixel_side, -4));
  Mesh slab;
  add_quad(slab, {{-0.9f, -0.6f, -2}, {-0.3f, -0.7f, -2}, {-0.2f, 0.7f, -2}, {-0.8f, 0.6f, -2}});
  add_part(scene, unlit("slab", {0.2f, 0.25f, 0.35f}), std::move(slab));
  scene.instances.back().world_from_object = translation(float3{speed * moment_of(values), 0, 0});
  add_motion(scene, flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace disocclusion_scene

BuiltinMaker builtin_disocclusion() {
  return {"disocclusion", "a slab that slides over a wall of small squares and uncovers it (godot issue 85399)",
          moment_params, disocclusion_scene::make};
}

}  // namespace zoneplate
