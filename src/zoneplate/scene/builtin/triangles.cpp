// SPDX-License-Identifier: Apache-2.0
// Scenes of a few simple triangles, whose coverage, order and colour can be computed by hand.
#include <cmath>
#include <initializer_list>

#include "zoneplate/image/transfer.h"
#include "zoneplate/scene/builtin/make.h"

namespace zoneplate {
namespace triangles_scene {
namespace {

constexpr float quarter_pi = 0.78539816f;

/// An unlit double-sided material with one colour, given as sRGB codes.
Material plain(const char* name, Rgba8 code) {
  Material m;
  m.name = name;
  m.model = ShadingModel::Unlit;
  m.double_sided = true;
  m.base_color = {decode_srgb8(code.r), decode_srgb8(code.g), decode_srgb8(code.b), 1};
  return m;
}

void add_triangle(Scene& scene, const char* name, std::initializer_list<float3> corners, Rgba8 code) {
  Mesh mesh;
  mesh.position = corners;
  const float3* p = corners.begin();
  mesh.normal.assign(3, normalize(cross(p[1] - p[0], p[2] - p[0])));
  mesh.index = {0, 1, 2};
  mesh.material = static_cast<int>(scene.materials.size());
  scene.materials.push_back(plain(name, code));
  add_object(scene, name, std::move(mesh));
}

Scene make_triangles(std::span<const std::int64_t>) {
  Scene scene;
  add_triangle(scene, "front", {{2, 0, -2}, {0, 2, -2}, {-2, 0, -2}}, {217, 238, 185});
  add_triangle(scene, "back", {{3.5f, -1, -5}, {2.5f, 1.5f, -5}, {-1, 0.5f, -5}}, {185, 217, 238});
  scene.cameras.push_back(camera_at({0, 0, 5}, {0, 0, 0}, quarter_pi, 0.1f, 50));
  return scene;
}

/// Each triangle comes closer to the eye from its tip to its base, and its base is in front of the next one's tip.
Scene make_cyclic(std::span<const std::int64_t>) {
  Scene scene;
  const float half_root3 = std::sqrt(3.0f) / 2;
  const float cosine[] = {1, -0.5f, -0.5f}, sine[] = {0, half_root3, -half_root3};
  constexpr Rgba8 codes[] = {{230, 92, 65}, {80, 170, 90}, {70, 120, 220}};
  constexpr const char* names[] = {"red", "green", "blue"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto turned = [&](float3 p) {
      return float3{cosine[i] * p.x - sine[i] * p.y, sine[i] * p.x + cosine[i] * p.y, p.z};
    };
    add_triangle(scene, names[i],
                 {turned({-1.9f, -0.45f, -0.5f}), turned({1.2f, -0.75f, 0.5f}), turned({1.2f, -0.15f, 0.5f})},
                 codes[i]);
  }
  scene.cameras.push_back(camera_at({0, 0, 5}, {0, 0, 0}, quarter_pi, 0.1f, 50));
  return scene;
}

/// Squares in the three coordinate planes: each pair intersects along an axis.
Scene make_crossing(std::span<const std::int64_t>) {
  Scene scene;
  constexpr Rgba8 codes[] = {{235, 120, 80}, {120, 190, 110}, {90, 130, 225}};
  constexpr const char* names[] = {"yz", "zx", "xy"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto corner = [&](float u, float v) {
      const float p[3] = {0, u, v};
      return float3{p[(3 - i) % 3], p[(4 - i) % 3], p[(5 - i) % 3]};
    };
    Mesh mesh;
    mesh.position = {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)};
    mesh.normal.assign(4, normalize(cross(mesh.position[1] - mesh.position[0], mesh.position[2] - mesh.position[0])));
    mesh.index = {0, 1, 2, 0, 2, 3};
    mesh.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(plain(names[i], codes[i]));
    add_object(scene, names[i], std::move(mesh));
  }
  scene.cameras.push_back(camera_at({2.6f, 1.9f, 3.3f}, {0, 0, 0}, quarter_pi, 0.1f, 50));
  return scene;
}

}  // namespace
}  // namespace triangles_scene

BuiltinMaker builtin_triangles() {
  return {"triangles", "two triangles, one before the other, in two pale colours", {}, triangles_scene::make_triangles};
}

BuiltinMaker builtin_cyclic() {
  return {"cyclic", "three long triangles, each before the next in a circle", {}, triangles_scene::make_cyclic};
}

BuiltinMaker builtin_crossing() {
  return {"crossing", "three squares that pass through each other", {}, triangles_scene::make_crossing};
}

}  // namespace zoneplate
