// SPDX-License-Identifier: Apache-2.0
// Procedural textures: noise, its fractal sums, solid textures, and their filtering.
#include <fmt/format.h>

#include <array>
#include <utility>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/lit_ball.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/shapes.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate::lessons {
namespace procedural_lesson {
namespace {

constexpr const char *method = "msaa:n=8", *reference = "ssaa:n=16";

constexpr Param params[] = {
    {.name = "octaves", .meaning = "of the fractal sum", .value = 6, .low = 3, .high = 8},
    {.name = "distortion",
     .meaning = "of the marble's waves by turbulence",
     .value = 1.6,
     .low = 0,
     .high = 5,
     .decimals = 1},
};
constexpr SolidTexture marble{
    .pattern = SolidPattern::Marble, .scale = 1.6f, .low = {0.84f, 0.82f, 0.79f}, .high = {0.09f, 0.10f, 0.12f}};
constexpr SolidTexture wood{
    .pattern = SolidPattern::Wood, .scale = 7, .low = {0.52f, 0.28f, 0.10f}, .high = {0.17f, 0.06f, 0.016f}};
constexpr SolidTexture rock{
    .pattern = SolidPattern::Rock, .scale = 3, .low = {0.06f, 0.052f, 0.045f}, .high = {0.52f, 0.47f, 0.41f}};

Rgba8Image pattern_picture(const std::string& parameters, int side) {
  return shown(make_pattern(fmt::format("perlin:size={},cell={},{}", side, side / 8.0, parameters)));
}

/// A smooth ball in the studio, its axis turned towards the viewer.
Scene sphere(const SolidTexture& texture) {
  Material material;
  material.metallic = 0, material.roughness = 0.35f;
  material.solid_texture = texture;
  Scene scene = lit_ball(material, 256, 128);
  scene.instances.front().world_from_object = rotation({1, 0, 0}, 0.7f) * rotation({0, 1, 0}, 0.5f);
  scene.lights.clear(), scene.ambient_light = {};
  return scene;
}

/// A plane to the horizon.
Scene floor(const SolidTexture& texture, bool is_filtered) {
  Scene scene;
  Mesh mesh;
  add_quad(mesh, {{-300, 0, 2}, {300, 0, 2}, {300, 0, -600}, {-300, 0, -600}});
  mesh.normal.assign(mesh.position.size(), {0, 1, 0});
  Material material = unlit("marble", {1, 1, 1});
  material.solid_texture = texture;
  material.solid_texture.is_filtered = is_filtered;
  add_part(scene, material, std::move(mesh));
  scene.cameras.push_back(camera_at({0, 2, 6}, {0, 0.4f, 0}, 0.75f, 0.1f, 1000));
  return scene;
}

std::array<Panel, 3> floors(const SolidTexture& texture, int side) {
  const LinearImage exact = shoot(floor(texture, false), reference, side, side);
  const auto error = [&](const LinearImage& image) {
    return number(100 * rms_difference(luminance_of(image), luminance_of(exact)), 1);
  };
  const LinearImage point_sampled = shoot(floor(texture, false), "none", side, side),
                    filtered = shoot(floor(texture, true), "none", side, side);
  return {
      {{shown(point_sampled),
        fmt::format("Point samples\nOne evaluation per pixel aliases towards the horizon. Error: {}\u00a0% of white.",
                    error(point_sampled))},
       {shown(filtered),
        fmt::format("Band-limited\nThe same cost: waves and octaves are attenuated by the pixel's footprint. "
                    "Error: {}\u00a0%.",
                    error(filtered))},
       {shown(exact), "Reference\n256 samples per pixel."}}};
}

Lesson make(const DemoSize& size, const Settings& settings) {
  Figure figure{.title = "Procedural textures: functions of position, filtered by the pixel's footprint", .rows = {}};
  const int side = size.panel, octaves = settings.integer("octaves");
  constexpr const char* words[] = {"", "", "", "Three", "Four", "Five", "Six", "Seven", "Eight"};
  figure.rows.push_back(
      {{pattern_picture("octaves=1", side), "Perlin noise\nRandom gradients at lattice points, 8 cells per side."},
       {pattern_picture("octaves=2", side), "Two octaves\nTwice the frequency, half the amplitude, added."},
       {pattern_picture(fmt::format("octaves={}", octaves), side),
        fmt::format("{} octaves\nA fractal sum: detail at every scale.", words[octaves])}});
  SolidTexture veined = marble;
  veined.distortion = static_cast<float>(settings.number("distortion"));
  const auto solid = [&](const SolidTexture& texture, const char* caption) {
    return Panel{shown(shoot(sphere(texture), method, side, side)), caption};
  };
  figure.rows.push_back(
      {solid(veined, "Marble\nPlane waves along x, their phase displaced by turbulence (sum of |noise|)."),
       solid(wood, "Wood\nRings around the y axis, displaced by noise, with a stretched grain."),
       solid(rock, "Rock\nA fractal sum, and the creases of turbulence.")});
  const std::array<Panel, 3> planes = floors(veined, side);
  figure.rows.push_back({planes.begin(), planes.end()});
  figure.text =
      "A solid texture is evaluated at the position in object space, so that a mesh needs no texture coordinates and "
      "has "
      "no seams. There is no image to build mip levels from; instead the function itself is filtered. A wave of f "
      "cycles "
      "per pixel is multiplied by sin(πf)/(πf), the response of a box one pixel wide; an octave of noise by the "
      "measured regression of its mean over the pixel. (Errors against 256 samples per pixel, root mean square of "
      "linear "
      "light.)";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace procedural_lesson

Demo demo_procedural() {
  return {"procedural", "noise, marble, wood and rock, and their filtering", procedural_lesson::make,
          procedural_lesson::params};
}

}  // namespace zoneplate::lessons
