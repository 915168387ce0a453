// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/builtin/shapes.h"

#include "zoneplate/math/angle.h"

namespace zoneplate {
namespace {

constexpr double two_pi = 6.283185307179586;

SineCosine turn(int part, int parts) {
  return sine_cosine(two_pi * static_cast<double>(part) / static_cast<double>(parts));
}

}  // namespace

Material unlit(const char* name, float3 light) {
  Material m;
  m.name = name;
  m.model = ShadingModel::Unlit;
  m.double_sided = true;
  m.base_color = {light.x, light.y, light.z, 1};
  return m;
}

Material lit(const char* name, float3 color) {
  Material m = unlit(name, color);
  m.model = ShadingModel::MetallicRoughness;
  m.metallic = 0, m.roughness = 1;
  return m;
}

void add_quad(Mesh& mesh, const float3 (&corner)[4]) {
  constexpr float2 uv[4] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  const float3 normal = normalize(cross(corner[1] - corner[0], corner[3] - corner[0]));
  for (std::size_t k = 0; k < 4; ++k) {
    mesh.position.push_back(corner[k]);
    mesh.normal.push_back(normal);
    mesh.uv0.push_back(uv[k]);
  }
  for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.index.push_back(first + k);
}

void add_quad(Mesh& mesh, const float3 (&corner)[4], float3 below, float3 above) {
  add_quad(mesh, corner);
  for (const float3 c : {below, below, above, above}) mesh.color.push_back({c.x, c.y, c.z, 1});
}

void add_box(Mesh& mesh, float3 a, float3 b) {
  add_quad(mesh, {{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}});
  add_quad(mesh, {{b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}});
  add_quad(mesh, {{b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}});
  add_quad(mesh, {{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}});
  add_quad(mesh, {{a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}});
  add_quad(mesh, {{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}});
}

void add_bar(Mesh& mesh, float3 from, float3 to, float radius, int sides) {
  const float3 along = normalize(to - from);
  const float3 across = normalize(cross(along, std::abs(along.y) < 0.9f ? float3{0, 1, 0} : float3{1, 0, 0}));
  const float3 third = cross(along, across);
  const auto at = [&](float3 end, int side) {
    const SineCosine t = turn(side, sides);
    return end + (across * static_cast<float>(t.cosine) + third * static_cast<float>(t.sine)) * radius;
  };
  for (int s = 0; s < sides; ++s) add_quad(mesh, {at(from, s), at(from, s + 1), at(to, s + 1), at(to, s)});
}

void add_wire(Mesh& mesh, float3 from, float3 to, float sag, float radius, int pieces) {
  const auto at = [&](int piece) {
    const float t = static_cast<float>(piece) / static_cast<float>(pieces);
    const float3 p = from + (to - from) * t;
    return float3{p.x, p.y - 4 * sag * t * (1 - t), p.z};
  };
  for (int i = 0; i < pieces; ++i) add_bar(mesh, at(i), at(i + 1), radius, 5);
}

void add_disc(Mesh& mesh, float3 centre, float radius, int corners) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  const auto n = static_cast<std::uint32_t>(corners);
  mesh.position.push_back(centre);
  for (int i = 0; i < corners; ++i) {
    const SineCosine t = turn(i, corners);
    mesh.position.push_back(centre + float3{static_cast<float>(t.cosine), static_cast<float>(t.sine), 0} * radius);
  }
  mesh.normal.resize(mesh.position.size(), {0, 0, 1});
  mesh.uv0.resize(mesh.position.size());
  for (std::uint32_t i = 0; i < n; ++i)
    for (const std::uint32_t k : {0u, 1 + i, 1 + (i + 1) % n}) mesh.index.push_back(first + k);
}

void add_part(Scene& scene, Material material, Mesh mesh) {
  mesh.material = static_cast<int>(scene.materials.size());
  const std::string name = material.name;
  scene.materials.push_back(std::move(material));
  add_object(scene, name.c_str(), std::move(mesh));
}

Camera flat_camera(float half_height) {
  Camera camera = camera_at({0, 0, 10}, {0, 0, 0}, 0.5f, 1, 100);
  camera.is_orthographic = true;
  camera.half_height = half_height;
  return camera;
}

}  // namespace zoneplate
