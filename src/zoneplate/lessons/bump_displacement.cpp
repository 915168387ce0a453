// SPDX-License-Identifier: Apache-2.0
// One height map as bump mapping, parallax occlusion mapping and displaced geometry, under the same light.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/scene/builtin/make.h"
#include "zoneplate/scene/geometry/displacement.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::lessons {
namespace bump_displacement_lesson {
namespace {

constexpr const char* method = "msaa:n=8";
constexpr Param params[] = {
    {.name = "height",
     .meaning = "of the studs, in radii of the sphere",
     .value = 0.16,
     .low = 0,
     .high = 0.4,
     .decimals = 2},
    {.name = "layers",
     .meaning = "of the height map that parallax occlusion tests along the ray",
     .value = 32,
     .low = 1,
     .high = 64},
};

/// Round studs, 8 × 4 over the map.
Rgba16Image studs() {
  constexpr int width = 512, rows = 256;
  Rgba16Image image(width, rows);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < width; ++x) {
      const float u = (static_cast<float>(x % 64) + 0.5f) / 32 - 1, v = (static_cast<float>(y % 64) + 0.5f) / 32 - 1;
      const float inside = std::clamp((0.62f - std::sqrt(u * u + v * v)) / 0.22f, 0.0f, 1.0f);
      const float value = inside * inside * (3 - 2 * inside);
      image(x, y) = {static_cast<std::uint16_t>(value * 65535 + 0.5f), 0, 0, 65535};
    }
  return image;
}

/// A unit sphere of latitudes and longitudes, with the map wrapped around it once.
Scene sphere(float height) {
  constexpr int columns = 128, rows = 64;
  Scene scene;
  Mesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const SineCosine latitude = sin_cos_pi(static_cast<double>(j) / rows),
                       longitude = sin_cos_pi(2.0 * (i % columns) / columns);
      const float3 p{static_cast<float>(latitude.sine * longitude.sine), static_cast<float>(latitude.cosine),
                     static_cast<float>(latitude.sine * longitude.cosine)};
      mesh.position.push_back(p), mesh.normal.push_back(normalize(p));
      mesh.uv0.push_back({static_cast<float>(i) / columns, static_cast<float>(j) / rows});
    }
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t q = j * (columns + 1) + i, r = q + columns + 1;
      if (j > 0) mesh.index.insert(mesh.index.end(), {q, r, q + 1});
      if (j + 1 < rows) mesh.index.insert(mesh.index.end(), {q + 1, r, r + 1});
    }
  Material clay;
  clay.name = "clay";
  clay.base_color = {0.62f, 0.34f, 0.20f, 1};
  clay.metallic = 0, clay.roughness = 0.45f;
  clay.height_texture.image = 0;
  clay.height_scale = height;
  scene.materials.push_back(clay);
  scene.images.push_back({"studs", studs()});
  add_object(scene, "sphere", std::move(mesh));
  Light sun;
  sun.direction = normalize(float3{-0.75f, -0.55f, -0.6f});
  sun.intensity = 3;
  scene.lights.push_back(sun);
  scene.environment.color = {0.25f, 0.27f, 0.30f};
  scene.cameras.push_back(camera_at({0, 0.9f, 4.2f}, {0, 0, 0}, 0.60f, 0.1f, 20));
  return scene;
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel;
  const auto height = static_cast<float>(settings.number("height"));
  Scene smooth = sphere(height), parallax = sphere(height), displaced = sphere(height);
  smooth.materials[0].height_texture = {};
  parallax.materials[0].parallax_layers = settings.integer("layers");
  displace_surfaces(displaced, {.tolerance = 0.001f});
  const std::uint64_t before = smooth.meshes[0].primitives(), after = displaced.meshes[0].primitives();

  Figure figure{.title = "One height map: shading alone, shifted coordinates, real geometry", .rows = {{}, {}}};
  const auto add = [&](const Scene& scene, const std::string& caption, const char* below) {
    const Rgba8Image image = shown(shoot(scene, method, side, side));
    constexpr int factor = 4;
    const int x = side * 78 / 100, y = side * 27 / 100;
    figure.rows[0].push_back({marked(image, x, y, factor, side), caption});
    figure.rows[1].push_back({crop_of(image, x, y, factor, side), below});
  };
  add(smooth, fmt::format("No height map\n{} triangles.", counted(before)), "The outline is a circle.");
  add(sphere(height),
      fmt::format("Bump mapping\nThe gradient of the heights turns the normal while shading. {} triangles.",
                  counted(before)),
      "The studs are shaded, but the outline stays a circle, and no stud hides another. Where a normal turns away "
      "from the viewer, Fresnel reflection of the grey surroundings replaces the colour.");
  add(parallax, "Parallax occlusion\nThe viewing ray is followed down to the height map, and coordinates are shifted.",
      "Studs hide each other; the outline is still a circle.");
  add(displaced,
      fmt::format("Displacement\nThe mesh is refined where the heights curve: {} triangles.", counted(after)),
      "The outline has studs.");
  figure.text =
      "Bump mapping changes only the normal; it fails where geometry shows, at the outline and at grazing angles. "
      "Displacement moves vertices, so that depth, outline and shadows follow, at the price of triangles. Edges are "
      "halved by position, on both sides of every seam, so that the displaced surface has no cracks.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace bump_displacement_lesson

Demo demo_bump_displacement() {
  return {"bump-displacement", "a height map as bumps, as parallax and as geometry", bump_displacement_lesson::make,
          bump_displacement_lesson::params};
}

}  // namespace zoneplate::lessons
