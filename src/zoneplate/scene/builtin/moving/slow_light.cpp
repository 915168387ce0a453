// SPDX-License-Identifier: Apache-2.0
// Surfaces at rest under light that changes slowly: one that grows bright and dark, the soft border of a spot light
// that moves, and transparent discs with soft borders that move.
#include <algorithm>
#include <cmath>

#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/builtin/moving/moving.h"

namespace zoneplate {
namespace slow_light_scene {
namespace {

Scene make_light_ramp(std::span<const std::int64_t> values) {
  constexpr float rise = 0.75f;  // seconds
  const float phase = moment_of(values) / (2 * rise), light = 1 - std::abs(2 * (phase - std::floor(phase)) - 1);
  Scene scene = *make_builtin_scene("sphere:triangles=3000");
  const Box box = scene.bounds();
  const float radius = box.size().y / 2, scale = 0.45f / radius;
  scene.instances[0].world_from_object =
      translation(float3{0.35f, 0, 0}) * scaling(float3{scale, scale, scale}) * translation(-box.centre());
  add_part(scene, lit("wall", {1, 1, 1}), make_squares(0.08f, -4));
  Mesh wires, lamp;
  for (int i = 0; i < 7; ++i) {
    const float y = 0.8f - 0.12f * static_cast<float>(i);
    add_wire(wires, {-1.3f, y, -2}, {1.3f, y + 0.1f, -2}, 0.08f, pixel_side);
  }
  add_part(scene, lit("wires", {0.8f, 0.75f, 0.6f}), std::move(wires));
  add_disc(lamp, {-0.75f, -0.55f, 1}, 0.25f);
  add_part(scene, unlit("lamp", float3{1, 0.9f, 0.7f} * light), std::move(lamp));
  Light key, fill;
  key.direction = normalize(float3{-0.5f, -0.6f, -0.7f}), key.intensity = 3 * light;
  fill.direction = normalize(float3{0.6f, -0.2f, -0.7f}), fill.intensity = 0.1f;
  scene.lights = {key, fill};
  add_motion(scene, flat_camera(1));
  return scene;
}

Scene make_soft_shadow(std::span<const std::int64_t> values) {
  constexpr float speed = 200 * pixel_side;  // 8.3 pixels per frame
  Scene scene;
  add_part(scene, lit("wall", {1, 1, 1}), make_squares(0.25f, -4));
  Mesh wires;
  for (int i = 0; i < 5; ++i) {
    const float x = -0.8f + 0.4f * static_cast<float>(i);
    add_bar(wires, {x, -1, -3.9f}, {x + 0.15f, 1, -3.9f}, pixel_side);
  }
  add_part(scene, lit("wires", {0.8f, 0.75f, 0.6f}), std::move(wires));
  Light spot, fill;
  spot.kind = LightKind::Spot, spot.position = {-0.8f + speed * moment_of(values), 0.1f, 4};
  spot.inner_cone = 0.03f, spot.outer_cone = 0.09f, spot.intensity = 200;
  fill.direction = {0, 0, -1}, fill.intensity = 0.4f;
  scene.lights = {spot, fill};
  add_motion(scene, flat_camera(1));
  return scene;
}

/// White, with alpha that falls from 1 in the middle to 0 at the border.
TextureImage soft_spot() {
  constexpr int texels = 64;
  Rgba8Image image(texels, texels);
  for (int y = 0; y < texels; ++y)
    for (int x = 0; x < texels; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) * 2 / texels - 1,
                  v = (static_cast<float>(y) + 0.5f) * 2 / texels - 1;
      const float inside = std::max(0.0f, 1 - (u * u + v * v));
      image(x, y) = {255, 255, 255, static_cast<std::uint8_t>(255 * inside * inside + 0.5f)};
    }
  return {"soft-spot", std::move(image)};
}

void add_soft_disc(Scene& scene, const char* name, float3 color, float radius, float3 place) {
  Material material = unlit(name, color);
  material.alpha_mode = AlphaMode::Blend;
  material.base_color_texture = {.image = 0, .sampler = {.wrap_u = Wrap::Clamp, .wrap_v = Wrap::Clamp}};
  Mesh mesh;
  add_quad(mesh, {{-radius, -radius, 0}, {radius, -radius, 0}, {radius, radius, 0}, {-radius, radius, 0}});
  add_part(scene, std::move(material), std::move(mesh));
  scene.instances.back().world_from_object = translation(place);
}

Scene make_soft_disc(std::span<const std::int64_t> values) {
  const float time = moment_of(values);
  constexpr float fast = 250 * pixel_side, slow = 60 * pixel_side;  // 10.4 and 2.5 pixels per frame
  Scene scene;
  scene.images.push_back(soft_spot());
  add_part(scene, unlit("wall", {1, 1, 1}), make_squares(0.25f, -4));
  add_soft_disc(scene, "bright disc", {1, 0.9f, 0.6f}, 0.5f, {-1 + fast * time, 0.4f, -2});
  add_soft_disc(scene, "dark disc", {0.02f, 0.03f, 0.05f}, 0.45f, {0.6f - slow * time, -0.45f, -1});
  add_motion(scene, flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace slow_light_scene

BuiltinMaker builtin_light_ramp() {
  return {"light-ramp", "a scene at rest under a light that grows bright and dark within seconds", moment_params,
          slow_light_scene::make_light_ramp};
}

BuiltinMaker builtin_soft_shadow() {
  return {"soft-shadow", "the soft border of a spot light, which moves over a wall at rest", moment_params,
          slow_light_scene::make_soft_shadow};
}

BuiltinMaker builtin_soft_disc() {
  return {"soft-disc", "transparent discs with soft borders that move over a wall at rest", moment_params,
          slow_light_scene::make_soft_disc};
}

}  // namespace zoneplate
