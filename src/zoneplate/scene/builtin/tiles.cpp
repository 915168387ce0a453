// SPDX-License-Identifier: Apache-2.0
// A tiled floor and a brick wall whose textures have nearest filtering and no mip levels.
#include "zoneplate/scene/builtin/bench.h"
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace tiles_scene {
namespace {

/// One tile of 128 × 128 texels: a dark joint on two sides, a narrow inlay inside.
TextureImage tile() {
  constexpr int size = 128, joint = 6, inlay = 26;
  Rgba8Image image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const bool is_joint = x < joint || y < joint;
      const bool is_inlay = (x == inlay || x == inlay + 1 || y == inlay || y == inlay + 1) && x > joint && y > joint;
      image(x, y) = is_joint ? Rgba8{38, 34, 32} : is_inlay ? Rgba8{176, 96, 60} : Rgba8{222, 214, 198};
    }
  return {"tile", std::move(image)};
}

/// A long rectangle in pieces, so that texture coordinates are small near the viewer.
void add_strip(Mesh& mesh, float3 origin, float3 across, float3 along, float2 uv_across, float2 uv_along, int pieces) {
  for (int i = 0; i < pieces; ++i) {
    const float a = static_cast<float>(i), b = a + 1;
    const std::size_t first = mesh.uv0.size();
    add_quad(mesh, {origin + along * a, origin + across + along * a, origin + across + along * b, origin + along * b});
    const float2 uv[4] = {{uv_along.x * a, uv_along.y * a},
                          {uv_across.x + uv_along.x * a, uv_across.y + uv_along.y * a},
                          {uv_across.x + uv_along.x * b, uv_across.y + uv_along.y * b},
                          {uv_along.x * b, uv_along.y * b}};
    for (std::size_t k = 0; k < 4; ++k) mesh.uv0[first + k] = uv[k];
  }
}

Material textured(const char* name, int image, float3 tint) {
  Material m = unlit(name, tint);
  m.base_color_texture = {
      .image = image,
      .sampler = {.magnify = TexelFilter::Nearest, .minify = TexelFilter::Nearest, .level = LevelFilter::None}};
  return m;
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  scene.images = {tile(), brick_texture()};
  Mesh sky, floor, wall;
  add_quad(sky, {{-900, -100, -480}, {900, -100, -480}, {900, 420, -480}, {-900, 420, -480}}, {0.75f, 0.80f, 0.86f},
           {0.22f, 0.38f, 0.66f});
  // Tiles of half a metre; on the wall, 6 m high, the texture of bricks repeats every 3 m.
  add_strip(floor, {-40, 0, 4}, {80, 0, 0}, {0, 0, -16}, {160, 0}, {0, 32}, 28);
  add_strip(wall, {-3.2f, 6, 4}, {0, -6, 0}, {0, 0, -16}, {0, 2}, {16 / 3.0f, 0}, 28);
  add_part(scene, unlit("sky", {1, 1, 1}), std::move(sky));
  add_part(scene, textured("floor", 0, {0.9f, 0.9f, 0.9f}), std::move(floor));
  add_part(scene, textured("wall", 1, {1, 1, 1}), std::move(wall));
  scene.cameras.push_back(camera_at({0, 1.7f, 2}, {-0.55f, 0.95f, -4}, 0.9f, 0.1f, 600));
  return scene;
}

}  // namespace
}  // namespace tiles_scene

BuiltinMaker builtin_tiles() {
  return {"tiles",
          "a floor of tiles and a brick wall, textures without smaller levels",
          {},
          tiles_scene::make,
          "texture aliasing",
          "Moiré in fine textures, and grid lines doubled by filters of edges: SMAAPlugin issue 9."};
}

}  // namespace zoneplate
