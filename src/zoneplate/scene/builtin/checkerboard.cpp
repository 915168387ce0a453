// SPDX-License-Identifier: Apache-2.0
// A checkerboard that extends to the horizon: it contains frequencies below and above the Nyquist limit of any image.
#include <array>

#include "zoneplate/scene/builtin/make.h"

namespace zoneplate {
namespace checkerboard_scene {
namespace {

constexpr int texels = 512, squares = 8;  // of one repetition of the texture, per side
constexpr float repeat = 8;               // metres per repetition: squares of one metre

Rgba8Image checks() {
  Rgba8Image image(texels, texels);
  for (int y = 0; y < texels; ++y)
    for (int x = 0; x < texels; ++x) {
      const bool is_light = ((x * squares / texels) + (y * squares / texels)) % 2 == 0;
      const std::uint8_t code = is_light ? 235 : 20;
      image(x, y) = {code, code, code, 255};
    }
  return image;
}

/// The grid lines are dense near the eye, so that uv are small there, and exact.
Mesh plane() {
  constexpr std::array<float, 14> lines = {-32768, -8192, -2048, -512, -128, -32,  -8,
                                           8,      32,    128,   512,  2048, 8192, 32768};
  constexpr auto n = static_cast<std::uint32_t>(lines.size());
  Mesh mesh;
  for (const float z : lines)
    for (const float x : lines) {
      mesh.position.push_back({x, 0, z});
      mesh.uv0.push_back({x / repeat, z / repeat});
    }
  mesh.normal.assign(mesh.position.size(), {0, 1, 0});
  for (std::uint32_t j = 0; j + 1 < n; ++j)
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
      const std::uint32_t far = j * n + i, near = far + n;
      for (const std::uint32_t v : {near, near + 1, far + 1, near, far + 1, far}) mesh.index.push_back(v);
    }
  return mesh;
}

Scene make(std::span<const std::int64_t>) {
  Scene scene;
  scene.images.push_back({"checkerboard", checks()});
  Material material;
  material.name = "checkerboard";
  material.model = ShadingModel::Unlit;
  material.double_sided = true;
  material.base_color_texture.image = 0;
  scene.materials.push_back(material);
  add_object(scene, "plane", plane());
  // The eyes of a person above the board, with the horizon in the upper third.
  scene.cameras.push_back(camera_at({0, 1.6f, 0}, {0, 0.1f, -7.5f}, 0.87266463f, 0.1f, 50000));
  return scene;
}

}  // namespace
}  // namespace checkerboard_scene

BuiltinMaker builtin_checkerboard() {
  return {"checkerboard", "a checkerboard of one metre squares to the horizon", {}, checkerboard_scene::make};
}

}  // namespace zoneplate
