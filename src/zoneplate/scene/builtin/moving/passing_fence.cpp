// SPDX-License-Identifier: Apache-2.0
// A fence at rest before a wall that moves sideways: history of the wall lies behind the bars.
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/moving/moving.h"

namespace zoneplate {
namespace passing_fence_scene {
namespace {

Scene make(std::span<const std::int64_t> values) {
  constexpr float speed = 55 * pixel_side;  // 2.3 pixels per frame
  Scene scene;
  add_part(scene, unlit("wall", {1, 1, 1}), make_squares(9 * pixel_side, -4));
  scene.instances.back().world_from_object = translation(float3{speed * moment_of(values), 0, 0});
  Mesh fence;
  for (int i = -40; i < 40; ++i) {
    const float x = 0.04f * static_cast<float>(i), half = 1.3f * pixel_side;
    add_quad(fence, {{x - half, -1, -2}, {x + half, -1, -2}, {x + 0.06f + half, 1, -2}, {x + 0.06f - half, 1, -2}});
  }
  add_part(scene, unlit("fence", {0.85f, 0.82f, 0.75f}), std::move(fence));
  add_motion(scene, flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace passing_fence_scene

BuiltinMaker builtin_passing_fence() {
  return {"passing-fence", "a fence at rest before a wall that passes by (FidelityFX-FSR2 issue 53)", moment_params,
          passing_fence_scene::make};
}

}  // namespace zoneplate
