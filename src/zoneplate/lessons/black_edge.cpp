// SPDX-License-Identifier: Apache-2.0
// The black edge: the artifact of one colour per pixel with four coverage samples.
//
// Both errors are reproduced intentionally from the renderer's samples, in the order of drawing.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"

namespace zoneplate::lessons {
namespace black_edge_lesson {
namespace {

constexpr int factor = 8;
constexpr int grids[] = {2, 3, 4};
constexpr Param params[] = {
    {.name = "grid", .meaning = "n × n coverage samples in a pixel", .value = 2, .choices = grids}};

/// A number of samples in words.
const char* words_of(std::size_t samples) { return samples == 4 ? "four" : samples == 9 ? "nine" : "sixteen"; }

/// The scene's samples: the visible triangle and the colour at each of a pixel's samples.
Frame sampled(const Scene& scene, int grid, int width, int height) {
  RenderOptions options{.width = width, .height = height};
  const auto resolver = make_resolver(antialias::methods(), fmt::format("msaa:grid={}", grid));
  Request request = resolver->request({});
  request.resolves_per_pixel = false;
  request.planes.samples = true;
  return render(PreparedScene(scene), camera_of(scene, width, height), request, options);
}

/// Draws the triangles one after the other, the nearer one first, into a colour buffer with one colour per pixel.
/// `draw(pixel, color, coverage)` draws a triangle's colour with this coverage into a pixel.
template <class Draw>
LinearImage drawn(const Frame& frame, Draw draw) {
  LinearImage out(frame.color.width(), frame.color.height(), Linear{0, 0, 0, 1});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      for (std::uint32_t triangle = 0; triangle < 2; ++triangle) {
        int owned = 0;
        Linear color;
        for (std::size_t s = 0; s < frame.sample_color.size(); ++s)
          if (frame.sample_triangle[s](x, y) == triangle) ++owned, color = frame.sample_color[s](x, y);
        if (owned > 0)
          out(x, y) = draw(out(x, y), color, static_cast<float>(owned) / static_cast<float>(frame.sample_color.size()));
      }
  return out;
}

LinearImage overwritten(const Frame& frame) {
  return drawn(frame, [](Linear, Linear color, float coverage) {
    return Linear{color.r * coverage, color.g * coverage, color.b * coverage, 1};
  });
}

LinearImage blended(const Frame& frame) {
  return drawn(frame,
               [](Linear before, Linear color, float coverage) { return before * (1 - coverage) + color * coverage; });
}

/// The correct image with one colour per sample: the mean of the visible colours.
LinearImage cured(const Frame& frame) {
  LinearImage out = frame.color;
  for (Linear& c : out.values()) c.a = 1;
  return out;
}

/// Statistics of the pixels that the two triangles cover completely: the number of dark pixels, and the least
/// brightness.
struct Darkness {
  int pixels = 0, dark = 0;
  float least = 1;  ///< smallest brightness relative to the correct one
};
Darkness measured(const Frame& frame, const LinearImage& picture) {
  Darkness out;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      int owned[2] = {};
      for (std::size_t s = 0; s < frame.sample_color.size(); ++s)
        if (const std::uint32_t t = frame.sample_triangle[s](x, y); t < 2) ++owned[t];
      if (owned[0] == 0 || owned[1] == 0 || owned[0] + owned[1] != static_cast<int>(frame.sample_color.size()))
        continue;
      const float brightness = picture(x, y).g / frame.color(x, y).g;
      ++out.pixels;
      out.dark += brightness < 0.999f;
      out.least = std::min(out.least, brightness);
    }
  return out;
}

std::string words_of(const Darkness& d) {
  return d.dark == 0 ? fmt::format("All {} pixels that both triangles cover have the correct brightness.", d.pixels)
                     : fmt::format("{} of {} pixels that both triangles cover are too dark, down to {}\u00a0%.", d.dark,
                                   d.pixels, number(100 * static_cast<double>(d.least), 0));
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel, x = side * 78 / 100, y = side * 42 / 100;
  const Frame frame = sampled(scene_of("triangles"), settings.integer("grid"), side, side);
  const char* const samples = words_of(frame.sample_color.size());
  Figure figure{.title = fmt::format("The black edge: {} coverage samples, but one colour per pixel", samples),
                .rows = {{}, {}}};
  const auto add = [&](const LinearImage& light, const std::string& caption) {
    const Rgba8Image picture = shown(light);
    figure.rows[0].push_back({marked(picture, x, y, factor, side), caption});
    figure.rows[1].push_back({crop_of(picture, x, y, factor, side), words_of(measured(frame, light))});
  };
  add(overwritten(frame),
      fmt::format(
          "Overwritten\nEach triangle writes its colour times its coverage. The far triangle, visible at one of "
          "{} samples, overwrites the near one's colour of the other{}.",
          samples, frame.sample_color.size() == 4 ? " three" : "s"));
  add(blended(frame),
      "Blended while drawing\nEach triangle is blended over the pixel's present colour: the near one over the black of "
      "the empty buffer, which remains in the result.");
  add(cured(frame),
      "Correct\nEvery sample has its own depth and colour. They are averaged once, after the last triangle.");
  figure.text = fmt::format(
      "All three test depth at {} samples, and draw the near triangle first. A pixel on its edge shows both "
      "triangles. With one colour per pixel, the part that is still empty when the near triangle is drawn counts as "
      "black: a dark line between two bright surfaces that touch, which the background does not explain. Colours must "
      "be averaged after the last triangle, over samples instead of triangles.",
      samples);
  return {.frames = {figure}};
}

}  // namespace
}  // namespace black_edge_lesson

Demo demo_black_edge() {
  return {"black-edge", "a dark line between bright surfaces: the bug, and its correction", black_edge_lesson::make,
          black_edge_lesson::params};
}

}  // namespace zoneplate::lessons
