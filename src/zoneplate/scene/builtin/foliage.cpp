// SPDX-License-Identifier: Apache-2.0
// Trees with alpha-tested leaves: edges inside of triangles, which multisampled coverage does not smooth.
#include <algorithm>
#include <cmath>

#include "zoneplate/math/random.h"
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace foliage_scene {
namespace {

constexpr int texels = 256;

/// A leaf of the twig: an ellipse along a direction from its base.
struct Leaf {
  float x, y, dx, dy, length, width;
  /// An approximate distance from the rim: about 1 in the middle and 0 on the rim.
  float inside(float u, float v) const {
    const float along = ((u - x) * dx + (v - y) * dy) / length, across = ((v - y) * dx - (u - x) * dy) / width;
    const float a = 2 * along - 1;
    return 1 - a * a - across * across * (1 + 2 * std::max(0.0f, along - 0.5f));
  }
};

/// Seven leaves on a stem; alpha falls to 0 within one or two texels, and the colour continues beyond the rim.
TextureImage twig() {
  constexpr Leaf leaves[] = {
      {0.50f, 0.42f, 0, -1, 0.40f, 0.10f},           {0.50f, 0.55f, 0.80f, -0.60f, 0.42f, 0.09f},
      {0.50f, 0.58f, -0.80f, -0.60f, 0.42f, 0.09f},  {0.50f, 0.72f, 0.94f, -0.34f, 0.42f, 0.085f},
      {0.50f, 0.74f, -0.94f, -0.34f, 0.42f, 0.085f}, {0.50f, 0.86f, 0.98f, 0.18f, 0.32f, 0.07f},
      {0.50f, 0.87f, -0.98f, 0.18f, 0.32f, 0.07f}};
  constexpr float sharpness = 30;  // alpha per texel at the rim
  Rgba8Image image(texels, texels);
  for (int y = 0; y < texels; ++y)
    for (int x = 0; x < texels; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / texels, v = (static_cast<float>(y) + 0.5f) / texels;
      float inside = v > 0.40f ? (0.010f - std::abs(u - 0.5f)) * 12 : -1.0f;
      float vein = 0;
      for (const Leaf& leaf : leaves) {
        const float here = leaf.inside(u, v);
        if (here > inside) inside = here, vein = std::abs((v - leaf.y) * leaf.dx - (u - leaf.x) * leaf.dy);
      }
      const float alpha = std::clamp(0.5f + inside * sharpness * 0.1f, 0.0f, 1.0f);
      const float light = vein < 0.008f ? 1.25f : 1.0f - 0.25f * std::clamp(vein * 10, 0.0f, 1.0f);
      const auto code = [&](float value) { return static_cast<std::uint8_t>(std::clamp(value * light, 0.0f, 255.0f)); };
      image(x, y) = {code(104), code(150), code(52), static_cast<std::uint8_t>(alpha * 255 + 0.5f)};
    }
  return {"twig", std::move(image)};
}

float random(std::uint32_t a, std::uint32_t b, std::uint32_t c) { return 2 * unit_float(hash(a, b, c)) - 1; }

/// Adds a ball of twigs about a centre, darker below.
void add_crown(Mesh& mesh, std::uint32_t tree, float3 centre, float radius, int twigs) {
  for (int i = 0; i < twigs; ++i) {
    const auto n = static_cast<std::uint32_t>(i);
    const auto axis = [&](std::uint32_t k) {
      return float3{random(tree, n, k), random(tree, n, k + 1), random(tree, n, k + 2)};
    };
    const float3 out = normalize(axis(0), {0, 1, 0}) * (0.62f + 0.38f * random(tree, n, 12));
    const float3 p = centre + float3{out.x, out.y * 0.85f, out.z} * radius;
    const float3 right = normalize(axis(3), {1, 0, 0}), up = normalize(cross(right, axis(6)), {0, 1, 0});
    const float size = radius * (0.30f + 0.08f * random(tree, n, 9));
    const float light = std::clamp(0.62f + 0.35f * out.y + 0.14f * random(tree, n, 10), 0.2f, 1.0f);
    const float3 color{light, light * (0.96f + 0.08f * random(tree, n, 11)), light * 0.85f};
    add_quad(mesh,
             {p - right * size - up * size, p + right * size - up * size, p + right * size + up * size,
              p - right * size + up * size},
             color, color);
  }
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  scene.images.push_back(twig());
  Mesh sky, ground, trunks, leaves;
  add_quad(sky, {{-900, -60, -500}, {900, -60, -500}, {900, 420, -500}, {-900, 420, -500}}, {0.86f, 0.88f, 0.90f},
           {0.16f, 0.34f, 0.68f});
  add_quad(ground, {{-900, 0, 20}, {900, 0, 20}, {900, 0, -499}, {-900, 0, -499}}, {0.10f, 0.13f, 0.04f},
           {0.34f, 0.36f, 0.20f});
  struct Tree {
    float x, z, height;
    int twigs;
  };
  constexpr Tree trees[] = {{-1.9f, -4.5f, 2.6f, 190}, {1.55f, -8, 3.4f, 260}, {-2.2f, -16, 4.4f, 260},
                            {5.6f, -24, 5.2f, 260},    {-10, -34, 6, 260},     {1.2f, -44, 6, 260},
                            {13, -58, 7, 240},         {-18, -72, 7, 240},     {3.5f, -95, 8, 240},
                            {-6, -120, 8, 240},        {24, -130, 9, 240}};
  std::uint32_t n = 0;
  for (const Tree& t : trees) {
    add_bar(trunks, {t.x, 0, t.z}, {t.x, t.height * 0.7f, t.z}, 0.022f * t.height, 10);
    add_crown(leaves, n++, {t.x, t.height * 0.72f, t.z}, t.height * 0.36f, t.twigs);
  }
  Material leaf = unlit("leaves", {1, 1, 1});
  leaf.alpha_mode = AlphaMode::Mask;
  leaf.base_color_texture = {.image = 0, .sampler = {.wrap_u = Wrap::Clamp, .wrap_v = Wrap::Clamp}};
  add_part(scene, unlit("sky", {1, 1, 1}), std::move(sky));
  add_part(scene, unlit("ground", {1, 1, 1}), std::move(ground));
  add_part(scene, unlit("trunks", {0.10f, 0.06f, 0.035f}), std::move(trunks));
  add_part(scene, std::move(leaf), std::move(leaves));
  scene.cameras.push_back(camera_at({0, 1.5f, 0}, {0, 1.9f, -10}, 0.80f, 0.2f, 600));
  return scene;
}

}  // namespace
}  // namespace foliage_scene

BuiltinMaker builtin_foliage() {
  return {"foliage",
          "trees near and far, their leaves cut out of a texture",
          {},
          foliage_scene::make,
          "alpha-tested foliage",
          "Leaves flicker, harden and vanish with distance: three.js issues 20522 and 14091."};
}

}  // namespace zoneplate
