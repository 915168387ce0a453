// SPDX-License-Identifier: Apache-2.0
// Polished metal with flutes and dents: highlights narrower than a pixel, which one shaded sample per pixel may miss.
#include <functional>

#include "zoneplate/math/angle.h"
#include "zoneplate/scene/builtin/bench.h"
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace metal_scene {
namespace {

constexpr double two_pi = 6.283185307179586;

struct Direction {
  float c = 1, s = 0;
};
Direction direction(float share_of_turn) {
  const SineCosine a = sine_cosine(two_pi * static_cast<double>(share_of_turn));
  return {static_cast<float>(a.cosine), static_cast<float>(a.sine)};
}

/// A surface parametrized by (u, v) in [0, 1]² on a grid; normals are differences of neighbouring positions, in the
/// direction of u × v.
Mesh surface(int nu, int nv, const std::function<float3(float u, float v)>& at) {
  Mesh mesh;
  const float du = 1 / static_cast<float>(nu), dv = 1 / static_cast<float>(nv);
  for (int j = 0; j <= nv; ++j)
    for (int i = 0; i <= nu; ++i) {
      const float u = static_cast<float>(i) * du, v = static_cast<float>(j) * dv;
      mesh.position.push_back(at(u, v));
      const float3 along_u = at(u + 0.25f * du, v) - at(u - 0.25f * du, v);
      const float3 along_v = at(u, v + 0.25f * dv) - at(u, v - 0.25f * dv);
      mesh.normal.push_back(normalize(cross(along_u, along_v), {0, 0, 1}));
    }
  mesh.index.resize(static_cast<std::size_t>(nu) * static_cast<std::size_t>(nv) * 6);
  fill_grid(mesh.index, 0, nu, nv);
  return mesh;
}

/// A vase: a profile rotated about its axis, with flutes.
Mesh vase() {
  return surface(640, 96, [](float u, float v) {
    const Direction turn = direction(u), flute = direction(36 * u), belly = direction(0.5f * v);
    const float radius = (0.34f + 0.24f * belly.s - 0.09f * v) * (1 + 0.022f * flute.c);
    return float3{-0.80f + radius * turn.s, -0.75f + 1.45f * v, radius * turn.c};
  });
}

/// A coil: a thin bar wound into a spring.
Mesh spring() {
  return surface(1400, 14, [](float u, float v) {
    const Direction turn = direction(11 * u), around = direction(v);
    const float radius = 0.30f + 0.030f * around.c;
    return float3{0.12f + radius * turn.c, -0.72f + 1.30f * u + 0.030f * around.s, -radius * turn.s};
  });
}

/// A hammered bowl, viewed from outside.
Mesh bowl() {
  return surface(360, 180, [](float u, float v) {
    const Direction turn = direction(u), tilt = direction(0.02f + 0.46f * v);
    const float3 out{tilt.s * turn.s, -tilt.c, tilt.s * turn.c};
    const float radius = 0.50f * (1 + 0.010f * bumps(2.2f * out.x, 2.2f * out.y, 2.2f * out.z));
    return float3{1.02f, -0.16f, 0} + out * radius;
  });
}

Material metal(const char* name, float3 color, float roughness) {
  Material m;
  m.name = name;
  m.base_color = {color.x, color.y, color.z, 1};
  m.metallic = 1, m.roughness = roughness;
  m.double_sided = true;
  return m;
}

void add_lamp(Scene& scene, float3 towards, float3 color, float intensity) {
  Light light;
  light.name = "lamp";
  light.direction = normalize(-towards);
  light.color = color;
  light.intensity = intensity;
  scene.lights.push_back(light);
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  Mesh wall;
  add_quad(wall, {{-9, -9, -3}, {9, -9, -3}, {9, 9, -3}, {-9, 9, -3}}, {0.10f, 0.10f, 0.11f}, {0.016f, 0.018f, 0.024f});
  add_part(scene, unlit("wall", {1, 1, 1}), std::move(wall));
  add_part(scene, metal("brass", {0.92f, 0.70f, 0.34f}, 0.22f), vase());
  add_part(scene, metal("steel", {0.80f, 0.82f, 0.85f}, 0.16f), spring());
  add_part(scene, metal("copper", {0.93f, 0.52f, 0.38f}, 0.20f), bowl());
  add_lamp(scene, {-0.6f, 0.8f, 0.9f}, {1, 0.96f, 0.90f}, 3);
  add_lamp(scene, {0.9f, 0.5f, 0.4f}, {0.75f, 0.85f, 1}, 2);
  add_lamp(scene, {0.1f, -0.6f, 0.8f}, {1, 0.8f, 0.65f}, 0.8f);
  scene.ambient_light = {0.1f, 0.1f, 0.1f};
  scene.cameras.push_back(camera_at({0.06f, 0.5f, 4.7f}, {0.06f, -0.05f, 0}, 0.50f, 0.5f, 20));
  return scene;
}

}  // namespace
}  // namespace metal_scene

BuiltinMaker builtin_metal() {
  return {"metal",
          "a fluted vase, a spring and a hammered bowl of polished metal",
          {},
          metal_scene::make,
          "specular shimmer",
          "Highlights sparkle and crawl on curved metal: three.js issue 30639, Bevy issue 24288, Filament issue 1218."};
}

}  // namespace zoneplate
