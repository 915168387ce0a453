// SPDX-License-Identifier: Apache-2.0
// A hull of riveted plates with a normal map: far away, many bumps lie within a pixel, and the highlight of the mean
// normal is not the mean of their highlights.
#include <algorithm>
#include <cmath>

#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace rivets_scene {
namespace {

/// A plate of 256 × 256 texels: two rows of domes along two of its sides, a groove, and fine brushing along u.
TextureImage plate_normals() {
  constexpr int size = 256, step = 32;
  constexpr float radius = 9;
  Rgba8Image image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      float nx = 0, ny = 0.03f * static_cast<float>((y * 37 + 11 * (y / 3)) % 9 - 4) / 4;
      const float dx = static_cast<float>(x % step - step / 2), dy = static_cast<float>(y % step - step / 2);
      const float square = dx * dx + dy * dy;
      const bool has_dome = x < step || y < step || (x / step % 2 == 0 && y / step % 4 == 2);
      if (has_dome && square < radius * radius) nx = 0.5f * dx / radius, ny = -0.5f * dy / radius;
      if (x >= size - 4) nx = x < size - 2 ? -0.3f : 0.3f;
      if (y >= size - 4) ny = y < size - 2 ? 0.3f : -0.3f;
      const float nz = std::sqrt(std::max(0.04f, 1 - nx * nx - ny * ny));
      const auto code = [](float v) { return static_cast<std::uint8_t>(127.5f + 127.5f * v); };
      image(x, y) = {code(nx), code(ny), code(nz), 255};
    }
  return {"plate", std::move(image)};
}

/// A hull that curves away: a strip of an upright cylinder, one plate per metre.
Mesh make_hull() {
  Mesh mesh;
  constexpr int pieces = 90;
  for (int i = 0; i < pieces; ++i) {
    const auto place = [](int k) {
      const float s = static_cast<float>(k) - 6;
      return float2{s, -0.003f * s * s};  // along the hull, and its distance
    };
    const float2 a = place(i), b = place(i + 1);
    const std::size_t first = mesh.position.size();
    add_quad(mesh, {{a.x, -8, a.y}, {b.x, -8, b.y}, {b.x, 12, b.y}, {a.x, 12, a.y}});
    const float u = static_cast<float>(i);
    const float2 uv[4] = {{u, 20}, {u + 1, 20}, {u + 1, 0}, {u, 0}};
    for (std::size_t k = 0; k < 4; ++k) {
      mesh.uv0[first + k] = uv[k];
      const float along = (k == 0 || k == 3 ? a : b).x;
      mesh.normal[first + k] = normalize(float3{0.006f * along, 0, 1});
    }
  }
  return mesh;
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  scene.images = {plate_normals()};
  Material hull;
  hull.name = "hull";
  hull.base_color = {0.62f, 0.66f, 0.70f, 1};
  hull.metallic = 1, hull.roughness = 0.22f;
  hull.normal_texture.image = 0;
  add_part(scene, std::move(hull), make_hull());
  Light sun;
  sun.name = "sun";
  sun.direction = normalize(float3{-0.75f, -0.35f, -0.45f});
  sun.color = {1, 0.94f, 0.85f};
  sun.intensity = 1;
  scene.lights.push_back(sun);
  scene.environment.color = {0.12f, 0.15f, 0.20f};
  scene.cameras.push_back(camera_at({-4.2f, 0.4f, 2.2f}, {0.6f, 0.5f, -0.6f}, 0.8f, 0.1f, 200));
  return scene;
}

}  // namespace
}  // namespace rivets_scene

BuiltinMaker builtin_rivets() {
  return {"rivets",
          "a riveted steel hull with a normal map; for --specular-aa",
          {},
          rivets_scene::make,
          "normal-map aliasing",
          "Highlights of detailed normal maps sparkle far away: Bevy issue 24288, Godot issue 45427."};
}

}  // namespace zoneplate
