// SPDX-License-Identifier: Apache-2.0
// 32 textured quads, each larger than a 16:9 image, from back to front: every pixel is drawn 32 times.
#include "zoneplate/math/angle.h"
#include "zoneplate/scene/builtin/bench.h"

namespace zoneplate {
namespace fill_scene {
namespace {

constexpr float quarter_pi = 0.78539816f;

Mesh quads() {
  constexpr float aspect = 16.0f / 9;
  const SineCosine half_fov = sine_cosine(static_cast<double>(quarter_pi * 0.5f));
  const auto slope = static_cast<float>(half_fov.sine / half_fov.cosine);
  BenchMesh out;
  for (int i = 0; i < 32; ++i) {
    const float z = 33.0f - static_cast<float>(i), h = z * slope * 1.01f, w = h * aspect;
    // Texels per pixel increase from 0.5 to 3.9, and each quad's texture is slightly rotated.
    const float texels = 0.5f + 0.11f * static_cast<float>(i);
    const SineCosine turn = sine_cosine(static_cast<double>(0.13f * static_cast<float>(i)));
    const auto c = static_cast<float>(turn.cosine), s = static_cast<float>(turn.sine);
    const float su = texels * 1080.0f * aspect / 1024.0f * 0.5f, sv = texels * 1080.0f / 1024.0f * 0.5f;
    float3 corner[4];
    float2 uv[4];
    for (int k = 0; k < 4; ++k) {
      const float x = k == 1 || k == 2 ? 1.0f : -1.0f, y = k >= 2 ? 1.0f : -1.0f;
      corner[k] = {x * w, y * h, -z};
      uv[k] = {c * x * su - s * y * sv, s * x * su + c * y * sv};
    }
    out.add_quad(corner, {0, 0, 1}, uv);
  }
  return std::move(out.mesh);
}

Scene make(const char* name, AlphaMode alpha) {
  Scene scene;
  scene.images.push_back(brick_texture());
  Material material;
  material.name = name;
  material.model = ShadingModel::Unlit;
  material.alpha_mode = alpha;
  material.double_sided = true;
  material.base_color_texture.image = 0;
  scene.materials.push_back(material);
  add_object(scene, name, quads());
  scene.cameras.push_back(camera_at({0, 0, 0}, {0, 0, -1}, quarter_pi, 0.5f, 50));
  return scene;
}

}  // namespace
}  // namespace fill_scene

BuiltinMaker builtin_fill() {
  return {"fill", "benchmark: 32 opaque layers over the whole image", {}, [](auto) {
            return fill_scene::make("fill", AlphaMode::Opaque);
          }};
}
BuiltinMaker builtin_fillblend() {
  return {"fillblend", "benchmark: 32 transparent layers over the whole image", {}, [](auto) {
            return fill_scene::make("fillblend", AlphaMode::Blend);
          }};
}

}  // namespace zoneplate
