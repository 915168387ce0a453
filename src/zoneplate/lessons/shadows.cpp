// SPDX-License-Identifier: Apache-2.0
// Shadows: maps under four filters against the exact visibility of a point and of a disc.
#include <fmt/format.h>

#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate::lessons {
namespace shadows_lesson {
namespace {

constexpr int map_size = 256, factor = 4;
constexpr float sun_radius = 0.035f;  // radians

/// A fence on a floor, under a low sun: a shadow that is sharp where it begins and blurred where it ends.
Scene make_scene() {
  Scene scene;
  const auto material = [](const char* name, float3 color) {
    Material m;
    m.name = name;
    m.model = ShadingModel::BlinnPhong;
    m.double_sided = true;
    m.base_color = {color.x, color.y, color.z, 1};
    m.ambient = color;
    return m;
  };
  Mesh floor, fence;
  add_quad(floor, {{-5, 0, 5}, {5, 0, 5}, {5, 0, -5}, {-5, 0, -5}});
  for (int i = 0; i < 9; ++i) {
    const float x = -1.6f + 0.4f * static_cast<float>(i);
    add_box(fence, {x - 0.06f, 0, -1.03f}, {x + 0.06f, 1.5f, -0.97f});
  }
  for (const float y : {0.35f, 1.15f}) add_box(fence, {-1.8f, y - 0.06f, -0.97f}, {1.8f, y + 0.06f, -0.93f});
  add_part(scene, material("floor", {0.72f, 0.70f, 0.66f}), std::move(floor));
  add_part(scene, material("fence", {0.55f, 0.30f, 0.16f}), std::move(fence));
  Light sun;
  sun.direction = normalize({0.30f, -0.62f, 0.72f});
  sun.intensity = 0.9f;
  sun.radius = sun_radius;
  scene.lights = {sun};
  scene.ambient_light = {0.12f, 0.14f, 0.18f};
  scene.cameras = {camera_at({0.9f, 3.1f, 4.2f}, {0.1f, 0.35f, -0.1f}, 0.72f, 0.1f, 40)};
  return scene;
}

struct Panel {
  ShadowOptions shadows;
  const char* caption;
};

ShadowOptions map_of(ShadowFilter filter, float radius) {
  return {.method = ShadowMethod::Map, .map = {.filter = filter, .size = map_size, .radius = radius}};
}

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, x = side * 60 / 100, y = side * 62 / 100;
  const Scene scene = make_scene();
  const auto draw = [&](const ShadowOptions& shadows) {
    return shoot(scene, "msaa:n=8", {.width = side, .height = side, .shadows = shadows});
  };
  const LinearImage sharp = draw({.method = ShadowMethod::Hard});
  const LinearImage soft = draw({.method = ShadowMethod::Soft, .samples = 128});
  const Plane<float> sharp_luminance = luminance_of(sharp), soft_luminance = luminance_of(soft);
  Figure figure{.title = "Shadows: depth images from the light, and exact visibility", .rows = {{}, {}, {}, {}}};
  int panels = 0;
  const auto add = [&](const LinearImage& light, const std::string& caption) {
    const std::size_t row = panels++ < 3 ? 0 : 2;
    const Rgba8Image picture = shown(light);
    figure.rows[row].push_back({marked(picture, x, y, factor, side), caption});
    const Plane<float> luminance = luminance_of(light);
    figure.rows[row + 1].push_back(
        {crop_of(picture, x, y, factor, side),
         fmt::format("Difference from the shadow of a point {}\u00a0%, of the disc {}\u00a0% (root mean square).",
                     number(100 * rms_difference(luminance, sharp_luminance), 1),
                     number(100 * rms_difference(luminance, soft_luminance), 1))});
  };
  add(draw(map_of(ShadowFilter::Nearest, 0.5f)),
      "Shadow map, nearest texel\nA depth image from the light says how far light reaches. Its texels are larger than "
      "pixels: the edge shows them as steps, which multisampling of the image leaves.");
  add(draw(map_of(ShadowFilter::Pcf, 1.5f)),
      "Percentage closer filtering\nThe mean of comparisons with 3 × 3 texels. Depths themselves must not be averaged: "
      "the mean depth of fence and floor is a depth where nothing is.");
  add(draw(map_of(ShadowFilter::Pcss, 1.5f)),
      "Percentage closer soft shadows\nThe filter's radius grows with the distance between floor and fence, by the "
      "mean "
      "depth of the blockers that were found.");
  add(draw(map_of(ShadowFilter::Evsm, 1.5f)),
      "Exponential variance shadow map\nFiltered mean and variance of warped depths bound the part of the light that "
      "is "
      "blocked. It may be filtered before it is used, as a texture may; where shadows overlap, light leaks.");
  add(sharp,
      "Exact, a point\nOne ray from each fragment to the light: no texels, no bias. The edge is as sharp everywhere, "
      "and one ray a pixel leaves its steps.");
  add(soft,
      "Exact, a disc\n128 rays to a sun of 4° diameter: sharp where the fence stands, blurred with the distance from "
      "it, as in PCSS, but without its guess.");
  figure.text = fmt::format(
      "The maps have {0} × {0} texels over the whole floor, so few that their artifacts are visible. A shadow map is "
      "cheap where the light or the scene stands still, but it samples the scene a second time, from the light, and "
      "aliases there: at the edges of its texels (steps), and where a texel covers a range of depths (acne, against "
      "which points are moved off their surface, which lets light through under the fence).",
      map_size);
  return {.frames = {figure}};
}

}  // namespace
}  // namespace shadows_lesson

Demo demo_shadows() {
  return {"shadows", "shadow maps and their filters against exact visibility", shadows_lesson::make};
}

}  // namespace zoneplate::lessons
