// SPDX-License-Identifier: Apache-2.0
#include "uploads.h"

#include <algorithm>

namespace zoneplate::peers {
namespace {

Rgba8Image half_of(const Rgba8Image& image) {
  Rgba8Image out(std::max(1, image.width() / 2), std::max(1, image.height() / 2));
  const auto mean = [](int a, int b, int c, int d) { return static_cast<std::uint8_t>((a + b + c + d + 2) / 4); };
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const int right = std::min(2 * x + 1, image.width() - 1), below = std::min(2 * y + 1, image.height() - 1);
      const Rgba8 p = image(2 * x, 2 * y), q = image(right, 2 * y), r = image(2 * x, below), s = image(right, below);
      out(x, y) = {mean(p.r, q.r, r.r, s.r), mean(p.g, q.g, r.g, s.g), mean(p.b, q.b, r.b, s.b),
                   mean(p.a, q.a, r.a, s.a)};
    }
  return out;
}

}  // namespace

std::vector<float> interleaved_vertices(const Mesh& mesh) {
  std::vector<float> out;
  out.reserve(mesh.position.size() * 8);
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    const float3 p = mesh.position[i], n = mesh.normal[i];
    const float2 uv = mesh.uv0[i];
    out.insert(out.end(), {p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y});
  }
  return out;
}

std::vector<Rgba8Image> mip_levels(const Rgba8Image& image) {
  std::vector<Rgba8Image> out{image};
  while (out.back().width() > 1 || out.back().height() > 1) out.push_back(half_of(out.back()));
  return out;
}

Uniforms uniforms_of(const Scene& scene, const Work& work) {
  const Material& m = scene.materials.at(0);
  const Camera& camera = scene.cameras.at(0);
  const float aspect = static_cast<float>(work.width) / static_cast<float>(work.height);
  Uniforms out{.clip_from_world = camera.clip_from_camera(aspect) * inverse(camera.world_from_camera)};
  // Zoneplate's depth is 1 at the near plane and 0 at the far plane.
  for (float4& column : out.clip_from_world.column) column.z = column.w - column.z;
  out.base = m.base_color;
  out.eye = camera.world_from_camera.column[3];
  out.look = {scene.ambient_light.x, m.specular.x, m.exponent, 0};
  if (scene.lights.empty()) return out;
  const float3 light = -scene.lights[0].direction;
  out.light = {light.x, light.y, light.z, 0};
  return out;
}

bool is_lit(const Scene& scene) { return scene.materials.at(0).model != ShadingModel::Unlit; }
bool is_textured(const Scene& scene) { return scene.materials.at(0).base_color_texture.image >= 0; }

}  // namespace zoneplate::peers
