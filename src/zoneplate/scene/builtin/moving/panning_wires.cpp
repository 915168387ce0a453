// SPDX-License-Identifier: Apache-2.0
// The scene `wires`, seen by a camera that pans slowly: 11 pixels per second in an image 480 pixels high.
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/builtin/moving/moving.h"

namespace zoneplate {
namespace panning_wires_scene {
namespace {

Scene make(std::span<const std::int64_t> values) {
  constexpr float speed = 0.017f;  // radians per second
  Scene scene = *make_builtin_scene("wires");
  Camera camera = scene.cameras[0];
  camera.world_from_camera = camera.world_from_camera * rotation({0, 1, 0}, speed * moment_of(values));
  add_motion(scene, camera);
  return scene;
}

}  // namespace
}  // namespace panning_wires_scene

BuiltinMaker builtin_panning_wires() {
  return {"panning-wires", "a slow pan over power lines and a fence, thinner than a pixel far away", moment_params,
          panning_wires_scene::make};
}

}  // namespace zoneplate
