// SPDX-License-Identifier: Apache-2.0
// A pergola in low sun: the shadow of thin slats, whose edges are steps of the texels of a shadow map, or of the
// pixels where one sample decides.
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace pergola_scene {
namespace {

Material painted(const char* name, float3 color, float roughness) {
  Material m;
  m.name = name;
  m.base_color = {color.x, color.y, color.z, 1};
  m.metallic = 0, m.roughness = roughness;
  return m;
}

/// Posts and beams of a roof of slats, 10 cm apart and 3 cm wide, above a terrace of 8 × 5 m.
Mesh make_pergola() {
  Mesh mesh;
  for (const float x : {-4.0f, 0.0f, 4.0f})
    for (const float z : {-5.0f, 0.0f}) add_box(mesh, {x - 0.06f, 0, z - 0.06f}, {x + 0.06f, 2.5f, z + 0.06f});
  for (const float z : {-5.0f, 0.0f}) add_box(mesh, {-4.3f, 2.5f, z - 0.05f}, {4.3f, 2.64f, z + 0.05f});
  for (int i = 0; i <= 84; ++i) {
    const float x = -4.2f + 0.1f * static_cast<float>(i);
    add_box(mesh, {x - 0.015f, 2.64f, -5.3f}, {x + 0.015f, 2.72f, 0.3f});
  }
  return mesh;
}

/// A railing of thin upright bars at the far side.
Mesh make_railing() {
  Mesh mesh;
  add_bar(mesh, {-4, 1, -5}, {4, 1, -5}, 0.02f);
  for (int i = 0; i <= 80; ++i) {
    const float x = -4 + 0.1f * static_cast<float>(i);
    add_bar(mesh, {x, 0, -5}, {x, 1, -5}, 0.008f);
  }
  return mesh;
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  Mesh terrace, wall;
  add_quad(terrace, {{-12, 0, 8}, {12, 0, 8}, {12, 0, -10}, {-12, 0, -10}});
  add_box(wall, {-12, 0, -10.4f}, {12, 3.4f, -10});
  add_part(scene, painted("wall", {0.72f, 0.68f, 0.60f}, 0.9f), std::move(wall));
  add_part(scene, painted("terrace", {0.62f, 0.56f, 0.48f}, 0.9f), std::move(terrace));
  add_part(scene, painted("wood", {0.42f, 0.28f, 0.17f}, 0.7f), make_pergola());
  add_part(scene, painted("steel", {0.20f, 0.21f, 0.22f}, 0.5f), make_railing());
  Light sun;
  sun.name = "sun";
  sun.direction = normalize(float3{0.32f, -0.62f, 0.72f});
  sun.color = {1, 0.93f, 0.82f};
  sun.intensity = 3;
  sun.radius = 0.00465f;
  scene.lights.push_back(sun);
  scene.environment.color = {0.20f, 0.24f, 0.32f};
  scene.cameras.push_back(camera_at({-1.6f, 1.75f, 5.2f}, {0.5f, 0.45f, -1.6f}, 0.85f, 0.1f, 60));
  return scene;
}

}  // namespace
}  // namespace pergola_scene

BuiltinMaker builtin_pergola() {
  return {"pergola",
          "the shadow of thin slats on a terrace; for --shadows map, hard and soft",
          {},
          pergola_scene::make,
          "shadow edges",
          "Edges of shadows stay jagged under multisampling and crawl with the camera: Bevy issue 8532, Filament issue "
          "3158."};
}

}  // namespace zoneplate
