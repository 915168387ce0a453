// SPDX-License-Identifier: Apache-2.0
// The trees of `foliage` in wind: alpha-tested edges that move, each twig in a direction and at a moment of its own.
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/builtin/moving/moving.h"

namespace zoneplate {
namespace swaying_foliage_scene {
namespace {

/// Moves every quad of a mesh of leaves as a whole: with its tree, and by itself.
void sway(Mesh& leaves, float time) {
  constexpr float two_pi = 6.2831853f;
  for (std::size_t quad = 0; quad < leaves.position.size() / 4; ++quad) {
    const auto random = [quad](std::uint32_t which) {
      return unit_float(hash(static_cast<std::uint32_t>(quad), which));
    };
    const float3 base = leaves.position[4 * quad];
    const float gust = 0.06f * base.y * sin(two_pi * 0.6f * time + 0.4f * base.x);
    const float flutter = 0.04f * sin(two_pi * ((1.2f + random(1)) * time + random(2)));
    const float3 way{gust + flutter, flutter * (random(3) - 0.5f), 0};
    for (std::size_t k = 0; k < 4; ++k) leaves.position[4 * quad + k] = leaves.position[4 * quad + k] + way;
  }
}

Scene make(std::span<const std::int64_t> values) {
  Scene scene = *make_builtin_scene("foliage");
  for (Mesh& mesh : scene.meshes)
    if (scene.materials[static_cast<std::size_t>(mesh.material)].alpha_mode == AlphaMode::Mask)
      sway(mesh, moment_of(values));
  add_motion(scene, scene.cameras[0]);
  return scene;
}

}  // namespace
}  // namespace swaying_foliage_scene

BuiltinMaker builtin_swaying_foliage() {
  return {"swaying-foliage", "the trees of foliage in wind (FidelityFX-FSR2 issue 38)", moment_params,
          swaying_foliage_scene::make};
}

}  // namespace zoneplate
