// SPDX-License-Identifier: Apache-2.0
// Makes a scene from arrays, renders colour and depth, and reads the pixels.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
using namespace zoneplate;

int main() {
  Mesh mesh;  // a pyramid: counter-clockwise triangles, metres, +Y up
  mesh.position = {{0, 1, 0}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
  for (const float3 p : mesh.position) mesh.normal.push_back(normalize(float3{p.x, p.y, p.z} - float3{0, 0.25f, 0}));
  mesh.index = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1};

  Scene scene;
  scene.meshes.push_back(mesh);
  scene.materials.push_back({.name = "clay", .base_color = {0.8f, 0.4f, 0.25f, 1}, .roughness = 0.7f});
  scene.objects.push_back("pyramid");
  scene.instances.push_back({.mesh = 0, .object = 0});
  light_unlit(scene);

  const int width = 320, height = 240;
  const Camera camera = choose_camera(scene, {}, static_cast<float>(width) / height);
  Renderer renderer(PreparedScene(std::move(scene)), make_resolver(antialias::methods(), "ssaa:n=16"));
  const RenderedImage image =
      renderer.render(camera, {.options = {.width = width, .height = height}, .planes = {.depth = true}});

  // `display` holds 8-bit sRGB values, rows from the top; `depth` the distance along the view axis in metres.
  const Rgba8 centre = image.display(width / 2, height / 2);
  float nearest = image.data.depth(0, 0);
  for (const float z : image.data.depth.values()) nearest = std::min(nearest, z);
  std::printf("centre: %d %d %d\nnearest depth: %.3f m\n", centre.r, centre.g, centre.b, static_cast<double>(nearest));
  return centre.r > centre.b && std::isfinite(nearest) ? 0 : 1;
}
