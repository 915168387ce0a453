// SPDX-License-Identifier: Apache-2.0
// A disc that jumps to another place every third of a second, and a wheel of spokes that turns.
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/moving/moving.h"

namespace zoneplate {
namespace teleport_scene {
namespace {

Mesh make_spokes() {
  Mesh mesh;
  for (int i = 0; i < 7; ++i) {
    const float4x4 turned = rotation({0, 0, 1}, 6.2831853f / 7 * static_cast<float>(i));
    const auto at = [&](float x, float y) { return xyz(turned * float4{x, y, -2, 1}); };
    add_quad(mesh, {at(-0.02f, 0.08f), at(0.02f, 0.08f), at(0.05f, 0.42f), at(-0.05f, 0.42f)});
  }
  return mesh;
}

Scene make(std::span<const std::int64_t> values) {
  const float time = moment_of(values);
  Scene scene;
  add_part(scene, unlit("wall", {1, 1, 1}), make_squares(0.25f, -4));
  Mesh disc;
  add_disc(disc, {0, 0, -1}, 0.22f);
  add_part(scene, unlit("disc", {0.95f, 0.7f, 0.1f}), std::move(disc));
  const float3 places[] = {{-0.8f, 0.45f, 0}, {0.1f, -0.5f, 0}, {0.75f, 0.5f, 0}, {-0.6f, -0.45f, 0}};
  scene.instances.back().world_from_object = translation(places[static_cast<int>(time * 3 + 1e-3f) % 4]);
  add_part(scene, unlit("spokes", {0.03f, 0.04f, 0.06f}), make_spokes());
  scene.instances.back().world_from_object = rotation({0, 0, 1}, -1.5f * time);
  add_motion(scene, flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace teleport_scene

BuiltinMaker builtin_teleport() {
  return {"teleport", "a disc that jumps three times a second, and spokes that turn", moment_params,
          teleport_scene::make};
}

}  // namespace zoneplate
