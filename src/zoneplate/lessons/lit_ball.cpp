// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/lessons/lit_ball.h"

#include <cstdint>

#include "zoneplate/math/angle.h"
#include "zoneplate/math/transform.h"

namespace zoneplate::lessons {
namespace {

constexpr double pi = 3.14159265358979323846;

Mesh ball(int columns, int rows) {
  Mesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const SineCosine polar = sine_cosine(pi * j / rows), azimuth = sine_cosine(2 * pi * i / columns);
      const float3 n{static_cast<float>(polar.sine * azimuth.sine), static_cast<float>(polar.cosine),
                     static_cast<float>(polar.sine * azimuth.cosine)};
      mesh.position.push_back(n), mesh.normal.push_back(n);
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (columns + 1) + i); };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      if (j > 0) mesh.index.insert(mesh.index.end(), {at(i, j), at(i + 1, j + 1), at(i + 1, j)});
      if (j + 1 < rows) mesh.index.insert(mesh.index.end(), {at(i, j), at(i, j + 1), at(i + 1, j + 1)});
    }
  return mesh;
}

}  // namespace

Scene lit_ball(const Material& material, int columns, int rows) {
  Scene scene;
  scene.meshes = {ball(columns, rows)};
  scene.objects = {"ball"};
  scene.instances = {{0, 0, {}}};
  scene.materials = {material};
  Light light;
  light.direction = normalize({0.5f, -0.55f, -0.67f});
  light.intensity = 0.9f;
  scene.lights = {light};
  scene.ambient_light = {0.1f, 0.1f, 0.1f};
  Camera camera;
  camera.is_orthographic = true, camera.half_height = 1.06f, camera.aspect = 0;
  camera.near = 1, camera.far = 5, camera.world_from_camera = translation({0, 0, 3});
  scene.cameras = {camera};
  return scene;
}

}  // namespace zoneplate::lessons
