// SPDX-License-Identifier: Apache-2.0
// Stars of at most a pixel above a ridge: light that one sample per pixel may hit or miss.
#include "zoneplate/math/random.h"
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace stars_scene {
namespace {

constexpr float pixel = 2.0f / 480;  // in an image 480 pixels high, for which the stars are sized

float random(std::uint32_t star, std::uint32_t which) { return unit_float(hash(star, which, 77)); }

Mesh make_stars() {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 520; ++i) {
    const float u = random(i, 2), side = pixel * (0.35f + 1.1f * u * u * u);
    const float x = 3.6f * (random(i, 0) - 0.5f);
    // Every third star is part of a band across the sky.
    const float spread = (random(i, 4) + random(i, 5) - 1) * 0.35f;
    const float y = i % 3 == 0 ? 0.25f + 0.45f * x + spread : 2.0f * (random(i, 1) - 0.5f) + 0.15f;
    const float v = random(i, 3), bright = 0.35f + 2.5f * v * v * v * v, warm = random(i, 6);
    const float3 color = float3{0.75f + 0.25f * warm, 0.82f, 1.0f - 0.35f * warm} * bright;
    add_quad(mesh, {{x, y, 0}, {x + side, y, 0}, {x + side, y + side, 0}, {x, y + side, 0}}, color, color);
  }
  return mesh;
}

/// The silhouette of the ridge: a polyline with segments of random length.
Mesh make_ridge() {
  Mesh mesh;
  constexpr int parts = 42;
  const auto top = [](int i) {
    const float n = random(static_cast<std::uint32_t>(i + 500), 8),
                m = random(static_cast<std::uint32_t>(i / 6 + 900), 9);
    return -0.72f + 0.13f * n + 0.24f * m;
  };
  for (int i = 0; i < parts; ++i) {
    const float a = -2.1f + 0.1f * static_cast<float>(i), b = a + 0.1f;
    add_quad(mesh, {{a, -2, 1}, {b, -2, 1}, {b, top(i + 1), 1}, {a, top(i), 1}});
  }
  return mesh;
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  Mesh sky;
  add_quad(sky, {{-9, -1, -1}, {9, -1, -1}, {9, 2, -1}, {-9, 2, -1}}, {0.022f, 0.035f, 0.085f},
           {0.001f, 0.002f, 0.008f});
  add_part(scene, unlit("sky", {1, 1, 1}), std::move(sky));
  add_part(scene, unlit("stars", {1, 1, 1}), make_stars());
  add_part(scene, unlit("ridge", {0.002f, 0.003f, 0.005f}), make_ridge());
  scene.cameras.push_back(flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace stars_scene

BuiltinMaker builtin_stars() {
  return {"stars", "stars of a third of a pixel to one and a half, and a ridge",
          {},      stars_scene::make,
          "stars", "Stars are taken for noise and smeared away, or blink as they move: DaemonEngine issue 1909."};
}

}  // namespace zoneplate
