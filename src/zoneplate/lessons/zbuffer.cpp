// SPDX-License-Identifier: Apache-2.0
// Hidden surfaces: the painter's algorithm, which has no order for surfaces that overlap in a circle, and the z-buffer.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/job/output/false_color.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate::lessons {
namespace zbuffer_lesson {
namespace {

LinearImage shot(const Scene& scene, Visibility visibility, int width, int height) {
  return shoot(scene, "none", {.width = width, .height = height, .visibility = visibility});
}

/// The pixels of `image` that differ from `reference` in vermilion, the others of `image` dimmed.
struct Difference {
  Rgba8Image image;
  int pixels = 0;
};
Difference difference_of(const LinearImage& image, const LinearImage& reference) {
  LinearImage out = image;
  int pixels = 0;
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    const bool differs = image.values()[i] != reference.values()[i];
    pixels += differs;
    out.values()[i] = differs ? Linear{0.66f, 0.11f, 0, 1} : out.values()[i] * 0.15f;
    out.values()[i].a = 1;
  }
  return {shown(out), pixels};
}

Rgba8Image depth_of(const Scene& scene, int width, int height) {
  Renderer renderer(PreparedScene(scene), make_resolver(antialias::methods(), "none"));
  Planes planes;
  planes.depth = true;
  const RenderedImage image = renderer.render(camera_of(scene, width, height),
                                              {.options = {.width = width, .height = height}, .planes = planes});
  Rgba8Image out(width, height);
  std::ranges::transform(depth_codes(image.data.depth).image.values(), out.values().begin(), [](std::uint16_t code) {
    const auto grey = static_cast<std::uint8_t>((code * 255u + 32895u) >> 16);  // the nearest of 8 bits
    return Rgba8{grey, grey, grey, 255};
  });
  return out;
}

Lesson make(const DemoSize& size, const Settings&) {
  const int width = size.panel, height = width * 3 / 4;
  Figure figure{.title = "The z-buffer decides visibility per sample, the painter's algorithm per triangle",
                .rows = {{}, {}}};
  std::size_t row = 0;
  struct Case {
    const char *scene, *heading, *words;
  };
  constexpr Case cases[] = {
      {"cyclic", "Three triangles overlap in a circle", "Each is in front of the next, so that no order is correct."},
      {"crossing", "Three squares intersect", "Each is partly in front of and partly behind the others."}};
  for (const Case& c : cases) {
    const Scene scene = scene_of(c.scene);
    Scene reversed = scene;
    std::reverse(reversed.instances.begin(), reversed.instances.end());
    const LinearImage painter = shot(scene, Visibility::Painter, width, height);
    const LinearImage buffer = shot(scene, Visibility::ZBuffer, width, height);
    const Difference wrong = difference_of(painter, buffer);
    const int moved = difference_of(shot(reversed, Visibility::ZBuffer, width, height), buffer).pixels;
    figure.rows[row].push_back({shown(painter), fmt::format("Painter's algorithm\n{}. {}", c.heading, c.words)});
    figure.rows[row].push_back({wrong.image, fmt::format("Its errors\n{} of {} pixels show a hidden surface.",
                                                         counted(static_cast<std::uint64_t>(wrong.pixels)),
                                                         counted(static_cast<std::uint64_t>(width * height)))});
    figure.rows[row].push_back(
        {shown(buffer),
         fmt::format("Z-buffer\nThe nearest surface at each sample. Drawn in the reverse order, {} pixels "
                     "differ.",
                     moved)});
    figure.rows[row].push_back(
        {depth_of(scene, width, height), "Depth\nThe z-buffer's contents: near is dark, far light."});
    ++row;
  }
  figure.text =
      "The painter's algorithm (--visibility painter) sorts n triangles in O(n log n) and draws them from the farthest "
      "to "
      "the nearest, here by their mean depth. The z-buffer keeps the least depth so far at each sample and takes a "
      "fragment only if it is nearer: O(n), in any order. It cannot blend transparent surfaces, which do need an "
      "order.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace zbuffer_lesson

Demo demo_zbuffer() {
  return {"zbuffer", "the z-buffer against the painter's algorithm, where no order exists", zbuffer_lesson::make};
}

}  // namespace zoneplate::lessons
