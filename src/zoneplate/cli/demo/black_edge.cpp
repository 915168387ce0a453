// The black edge: what comes of one colour a pixel where coverage is known at four samples.
//
// Both mistakes are made here on purpose, from what the renderer knows of each sample, in the order of drawing.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/cli/demo/demo.h"
#include "zoneplate/cli/demo/picture.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"

namespace zoneplate::cli {
namespace {

constexpr int factor = 8, samples = 4;

/// The scene's samples: for each of a pixel's four the triangle that is seen there, and its colour.
Frame sampled(const Scene& scene, int width, int height) {
  RenderOptions options{.width = width, .height = height};
  const auto resolver = make_resolver(antialias::methods(), "msaa:grid=2");
  Request request = resolver->request({});
  request.resolves_per_pixel = false;
  request.planes.samples = true;
  return render(PreparedScene(scene), camera_of(scene, width, height), request, options);
}

/// A pixel of one colour buffer without samples, while triangles are drawn one after the other, the nearer one first.
/// `draw(pixel, color, share)` lays a triangle's colour, seen at this share of the samples, into it.
template <class Draw>
LinearImage drawn(const Frame& frame, Draw draw) {
  LinearImage out(frame.color.width(), frame.color.height(), Linear{0, 0, 0, 1});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x)
      for (std::uint32_t triangle = 0; triangle < 2; ++triangle) {
        int owned = 0;
        Linear color;
        for (std::size_t s = 0; s < samples; ++s)
          if (frame.sample_triangle[s](x, y) == triangle) ++owned, color = frame.sample_color[s](x, y);
        if (owned > 0) out(x, y) = draw(out(x, y), color, static_cast<float>(owned) / samples);
      }
  return out;
}

LinearImage overwritten(const Frame& frame) {
  return drawn(frame, [](Linear, Linear color, float share) {
    return Linear{color.r * share, color.g * share, color.b * share, 1};
  });
}

LinearImage blended(const Frame& frame) {
  return drawn(frame, [](Linear before, Linear color, float share) { return before * (1 - share) + color * share; });
}

/// A colour for each sample: the mean of what is seen.
LinearImage cured(const Frame& frame) {
  LinearImage out = frame.color;
  for (Linear& c : out.values()) c.a = 1;
  return out;
}

/// Of the pixels that the two triangles share without a gap: how many have too little light, and how little.
struct Darkness {
  int pixels = 0, dark = 0;
  float least = 1;  ///< of the light that the pixel should have
};
Darkness measured(const Frame& frame, const LinearImage& picture) {
  Darkness out;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      int owned[2] = {};
      for (std::size_t s = 0; s < samples; ++s)
        if (const std::uint32_t t = frame.sample_triangle[s](x, y); t < 2) ++owned[t];
      if (owned[0] == 0 || owned[1] == 0 || owned[0] + owned[1] != samples) continue;
      const float share = picture(x, y).g / frame.color(x, y).g;
      ++out.pixels;
      out.dark += share < 0.999f;
      out.least = std::min(out.least, share);
    }
  return out;
}

std::string words_of(const Darkness& d) {
  return d.dark == 0 ? fmt::format("All of {} pixels that the triangles share have the light that is theirs.", d.pixels)
                     : fmt::format("{} of {} pixels that the triangles share have too little light, down to {}\u00a0%.",
                                   d.dark, d.pixels, number(100 * static_cast<double>(d.least), 0));
}

Lesson make(const DemoSize& size) {
  const int side = size.panel, x = side * 78 / 100, y = side * 42 / 100;
  const Frame frame = sampled(scene_of("triangles"), side, side);
  Figure figure{.title = "The black edge: four samples, but one colour a pixel", .rows = {{}, {}}};
  const auto add = [&](const LinearImage& light, const char* caption) {
    const Rgba8Image picture = shown(light);
    figure.rows[0].push_back({marked(picture, x, y, factor, side), caption});
    figure.rows[1].push_back({crop_of(picture, x, y, factor, side), words_of(measured(frame, light))});
  };
  add(overwritten(frame),
      "Overwritten\nEach triangle writes its colour times its share of the samples. The far one, seen at one sample "
      "of four, wipes out what the near one wrote for three.");
  add(blended(frame),
      "Blended while drawn\nEach triangle is mixed over what the pixel holds by then: the near one over the black of "
      "an empty buffer, which stays in the pixel for good.");
  add(cured(frame),
      "Cured\nEvery sample keeps a depth and a colour of its own. They are averaged once, when all is drawn.");
  figure.text =
      "Depth is tested at four samples in all three; the near triangle is drawn first. A pixel on its edge belongs to "
      "both. Where the buffer has one colour for them, the part that is still empty when the near one is drawn counts "
      "as black: a dark line between two bright surfaces that touch, which no background explains. Light has to be "
      "averaged after the last triangle, over samples, not over triangles.";
  return {.frames = {figure}};
}

}  // namespace

Demo demo_black_edge() {
  return {"black-edge", "a dark line between bright surfaces: the bug made on purpose, and its cure", make};
}

}  // namespace zoneplate::cli
