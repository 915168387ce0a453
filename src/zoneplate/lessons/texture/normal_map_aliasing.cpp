// SPDX-License-Identifier: Apache-2.0
// Highlights that flicker: normals that change within a pixel, and roughness that accounts for them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/make.h"
#include "zoneplate/shade/texture/height_normals.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::lessons {
namespace normal_map_aliasing_lesson {
namespace {

constexpr int texels = 256, factor = 4;
constexpr const char* reference_method = "ssaa:samples=256";

/// A periodic sea: 40 waves, the shorter the lower.
Plane<float> waves() {
  constexpr std::uint32_t count = 40;
  Plane<float> heights(texels, texels, 0.0f);
  for (std::uint32_t n = 0; n < count; ++n) {
    const int most = 2 + static_cast<int>(n) / 4;
    const auto cycles = [&](std::uint32_t axis) {
      return static_cast<int>(hash(n, axis, 21) % static_cast<std::uint32_t>(2 * most + 1)) - most;
    };
    const int along_x = cycles(0), along_y = cycles(1);
    const double phase = 2.0 * static_cast<double>(unit_float(hash(n, 2, 21)));
    const double length = std::sqrt(static_cast<double>(along_x * along_x + along_y * along_y));
    if (length < 1) continue;
    for (int y = 0; y < texels; ++y)
      for (int x = 0; x < texels; ++x)
        heights(x, y) += static_cast<float>(sin_pi(2.0 * (along_x * x + along_y * y) / texels + phase) / length);
  }
  return heights;
}

/// The sea to the horizon, towards the sun.
Scene sea() {
  Scene scene;
  const Plane<float3> normals = normals_of(waves(), {.strength = 1.6f});
  Rgba8Image map(texels, texels);
  std::ranges::transform(normals.values(), map.values().begin(), [](float3 n) {
    const auto code = [](float v) { return static_cast<std::uint8_t>((0.5f + 0.5f * v) * 255 + 0.5f); };
    return Rgba8{code(n.x), code(n.y), code(n.z), 255};
  });
  scene.images.push_back({"waves", std::move(map)});

  Material water;
  water.name = "water";
  water.base_color = {0.02f, 0.06f, 0.08f, 1};
  water.metallic = 0, water.roughness = 0.2f;
  water.normal_texture.image = 0;
  scene.materials.push_back(water);

  Mesh mesh;
  constexpr float half = 60, repeat = 2.5f;
  for (const float z : {-2 * half, 2.0f})
    for (const float x : {-half, half}) {
      mesh.position.push_back({x, 0, z});
      mesh.normal.push_back({0, 1, 0});
      mesh.tangent.push_back({1, 0, 0, 1});
      mesh.uv0.push_back({x / repeat, z / repeat});
    }
  mesh.index = {0, 2, 3, 0, 3, 1};
  add_object(scene, "sea", std::move(mesh));
  Light sun;
  sun.direction = normalize(float3{0.0f, -0.22f, 1});
  sun.color = {1, 0.85f, 0.6f};
  sun.intensity = 0.35f;
  scene.lights.push_back(sun);
  scene.environment.color = {0.12f, 0.17f, 0.25f};
  scene.cameras.push_back(camera_at({0, 1.7f, 0}, {0, 0.4f, -6}, 0.7f, 0.1f, 500));
  return scene;
}

LinearImage clamped(LinearImage image) {
  for (Linear& c : image.values()) c = {std::min(c.r, 1.0f), std::min(c.g, 1.0f), std::min(c.b, 1.0f), c.a};
  return image;
}

double mean_of(const LinearImage& image) {
  const Plane<float> luminance = luminance_of(image);
  double sum = 0;
  for (const float v : luminance.values()) sum += static_cast<double>(v);
  return sum / static_cast<double>(image.values().size());
}

/// The difference between an image and that of a camera that is turned by half a pixel.
double flicker(const LinearImage& image, const LinearImage& turned) {
  return rms_difference(luminance_of(clamped(image)), luminance_of(clamped(turned)));
}

/// Shots of a scene by each kind of widening, against a reference: of side / shrink pixels, enlarged to `side`.
void add_rows(const Scene& scene, const char* name, std::span<const std::pair<SpecularAntialiasing, const char*>> kinds,
              int side, int shrink, int2 centre, Figure& figure, Table& table) {
  // The same with the camera turned by half a pixel.
  Scene turned = scene;
  Camera& camera = turned.cameras.at(0);
  const float half_pixel = 0.5f * camera.vertical_fov * static_cast<float>(shrink) / static_cast<float>(side);
  camera.world_from_camera = camera.world_from_camera * rotation({0, 1, 0}, half_pixel);
  const auto shot = [&](const Scene& of, const char* method, SpecularAntialiasing kind) {
    return shoot(of, method,
                 RenderOptions{.width = side / shrink, .height = side / shrink, .anisotropy = 8, .specular_aa = kind});
  };
  const LinearImage reference = shot(scene, reference_method, SpecularAntialiasing::None);
  std::vector<Panel> pictures, crops;
  const auto add = [&](const LinearImage& image, const std::string& caption) {
    const Rgba8Image picture = enlarged(shown(clamped(image)), shrink);
    if (shrink > 1) return pictures.push_back({picture, caption});
    pictures.push_back({marked(picture, centre.x, centre.y, factor, side), caption});
    crops.push_back({crop_of(picture, centre.x, centre.y, factor, side), ""});
  };
  for (const auto& [kind, caption] : kinds) {
    const LinearImage image = shot(scene, "msaa:n=8", kind);
    const double error = rms_difference(luminance_of(clamped(image)), luminance_of(clamped(reference)));
    const double change = flicker(image, shot(turned, "msaa:n=8", kind));
    const double energy = mean_of(image) / mean_of(reference) - 1;
    const std::string heading(std::string_view(caption).substr(0, std::string_view(caption).find('\n')));
    add(image, fmt::format("{} Error {}\u00a0%, flicker {}\u00a0%.", caption, number(100 * error, 2),
                           number(100 * change, 2)));
    table.rows.push_back({name, heading, number(100 * error, 2) + " %", number(100 * change, 2) + " %",
                          (energy > 0 ? "+" : "") + number(100 * energy, 1) + " %"});
  }
  const double change = flicker(reference, shot(turned, reference_method, SpecularAntialiasing::None));
  table.rows.push_back({name, "256 samples", "", number(100 * change, 2) + " %", ""});
  add(reference, fmt::format("256 samples per pixel\nThe reference. Flicker {}\u00a0%.", number(100 * change, 2)));
  figure.rows.push_back(std::move(pictures));
  if (!crops.empty()) figure.rows.push_back(std::move(crops));
}

/// The metal in lights so weak that few highlights are clipped to white, with all of its objects in a square image.
Scene metal() {
  Scene scene = scene_of("metal");
  scene.cameras.at(0).vertical_fov = 0.68f;
  for (Light& light : scene.lights) light.intensity *= 0.15f;
  return scene;
}

Lesson make(const DemoSize& size, const Settings&) {
  using Kind = SpecularAntialiasing;
  const int side = size.panel;
  Figure figure{.title = "Normal map aliasing: highlights smaller than a pixel"};
  Table table{{"scene", "--specular-aa", "error", "flicker", "mean luminance"}, {}};
  const std::pair<Kind, const char*> of_sea[] = {
      {Kind::None, "none\nEach pixel is shaded with one normal: multisampling smooths edges, not highlights."},
      {Kind::Toksvig, "toksvig\nShorter mean normals mean wider lobes."},
      {Kind::Lean, "lean\nThe variances of the slopes widen the lobe."}};
  const std::pair<Kind, const char*> of_metal[] = {
      {Kind::None, "none\nCurved metal: highlights thinner than a pixel break into dots."},
      {Kind::Geometric,
       "geometric\nThe change of the normal from pixel to pixel widens the lobe: it helps the spring and the smooth "
       "metal. The "
       "hammered ball has several highlights per pixel, which one wide lobe turns into brown patches."}};
  add_rows(sea(), "waves", of_sea, side, 1, {side / 2, side * 4 / 10}, figure, table);
  add_rows(metal(), "metal", of_metal, side, 2, {}, figure, table);
  figure.text = fmt::format(
      "All images but the references with 8 coverage samples per pixel. The frames mark the regions that are enlarged "
      "{0} "
      "times; the metal is rendered at half the size and enlarged twice. Errors: root mean square of the difference in "
      "luminance, of linear light clamped to white; flicker: the same between two images, the camera turned by half a "
      "pixel. The reference flickers too: its highlights move, and those of the aliased images are clamped to white "
      "before and after. Sources: Toksvig, Mipmapping Normal Maps, 2005; Olano and Baker, LEAN Mapping, 2010; "
      "Tokuyoshi and "
      "Kaplanyan, 2021.",
      factor);
  return {.frames = {figure}, .tables = {table}};
}

}  // namespace
}  // namespace normal_map_aliasing_lesson

Demo demo_normal_map_aliasing() {
  return {"normal-map-aliasing", "highlights of normal maps and curved metal, and roughness that accounts for them",
          normal_map_aliasing_lesson::make};
}

}  // namespace zoneplate::lessons
