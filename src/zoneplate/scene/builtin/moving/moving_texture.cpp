// SPDX-License-Identifier: Apache-2.0
// A texture that scrolls over a surface at rest: its motion is not that of the surface.
#include "zoneplate/math/random.h"
#include "zoneplate/scene/builtin/moving/moving.h"

namespace zoneplate {
namespace moving_texture_scene {
namespace {

/// Bars and squares of 4 × 4 texels in strong colours, and rows of dashes two texels high between them.
TextureImage marks() {
  constexpr int size = 128, cell = 4;
  Rgba8Image image(size, size);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto random = [&](std::uint32_t which) {
        return hash(static_cast<std::uint32_t>(x / cell), static_cast<std::uint32_t>(y / cell), which) % 4;
      };
      const auto code = [&](std::uint32_t which) { return static_cast<std::uint8_t>(40 + 64 * random(which)); };
      const bool is_dash = y / cell % 4 == 0 && y % cell < 2;
      image(x, y) =
          is_dash ? (random(4) < 2 ? Rgba8{245, 240, 225} : Rgba8{20, 20, 28}) : Rgba8{code(1), code(2), code(3)};
    }
  return {"marks", std::move(image)};
}

Scene make(std::span<const std::int64_t> values) {
  constexpr float speed = 44 * pixel_side;  // 1.8 pixels per frame
  constexpr float side = 128 * 2 * pixel_side;
  Scene scene;
  scene.images = {marks()};
  add_part(scene, unlit("wall", {1, 1, 1}), make_squares(0.2f, -4));
  Mesh belt;
  add_quad(belt, {{-1.1f, -0.5f, -2}, {1.1f, -0.6f, -2}, {1.1f, 0.5f, -2}, {-1.1f, 0.6f, -2}});
  for (float2& uv : belt.uv0) uv = {uv.x * 2.2f / side, uv.y * 1.1f / side};
  Material moving = unlit("belt", {1, 1, 1});
  moving.base_color_texture = {.image = 0, .offset = {-speed * moment_of(values) / side, 0}};
  add_part(scene, std::move(moving), std::move(belt));
  add_motion(scene, flat_camera(1));
  return scene;
}

}  // namespace
}  // namespace moving_texture_scene

BuiltinMaker builtin_moving_texture() {
  return {"moving-texture", "a texture that scrolls over a belt at rest (godot issue 69493)", moment_params,
          moving_texture_scene::make};
}

}  // namespace zoneplate
