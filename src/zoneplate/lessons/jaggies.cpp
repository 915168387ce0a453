// SPDX-License-Identifier: Apache-2.0
// Jaggies: one sample per pixel gives a coverage of 0 or 1; the mean of several samples approximates the coverage.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/metrics/mse.h"

namespace zoneplate::lessons {
namespace jaggies_lesson {
namespace {

constexpr const char* reference = "ssaa:n=16";
constexpr int factor = 8;

struct Way {
  const char *method, *heading, *words;
};
constexpr std::array<Way, 3> ways = {
    {{"none", "One sample per pixel", "A pixel is either teapot or background: edges become staircases."},
     {"msaa:n=8", "8 samples, shaded once",
      "Coverage has 8 samples, shading one per surface: smooth outlines at little cost."},
     {"ssaa:n=4", "16 shaded samples", "Highlights inside the outline become smooth as well."}}};

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, height = side * 3 / 4;
  const Scene scene = scene_of("teapot");
  RenderCounts counts;
  const LinearImage exact = shoot(scene, reference, side, height, &counts);
  const DisplayImage exact_display = make_display(exact, {});

  // The right end of the lid and its seat: outlines, a seam, and highlights narrower than a pixel.
  const int x = side * 57 / 100, y = side * 20 / 100;
  Figure figure{.title = "Jaggies: with one sample, a pixel is covered either completely or not at all",
                .rows = {{}, {}}};
  const auto add = [&](const LinearImage& light, std::string caption, std::string crop_caption) {
    const Rgba8Image picture = shown(light);
    figure.rows[0].push_back({marked(picture, x, y, factor, side), std::move(caption)});
    figure.rows[1].push_back({crop_of(picture, x, y, factor, side), std::move(crop_caption)});
  };
  for (const Way& way : ways) {
    RenderCounts done;
    const LinearImage light = shoot(scene, way.method, side, height, &done);
    const double error = std::sqrt(metrics::mean_squared_error(exact_display, make_display(light, {})));
    add(light, fmt::format("{}\n{}", way.heading, way.words),
        fmt::format("--aa {}\n{} shaded samples, error {}\u00a0%.", way.method, counted(done.shaded),
                    number(100 * error, 2)));
  }
  add(exact, "256 samples, the reference\nA 16 × 16 grid in each pixel approximates the covered area.",
      fmt::format("--aa {}\n{} shaded samples.", reference, counted(counts.shaded)));
  figure.text =
      "The frames mark the regions below, enlarged 8 times. Error: root mean square difference from the reference, of "
      "sRGB values, white being 100 %. No method makes edges sharper than a pixel: a good one blends the colours of "
      "both sides of an edge by the area that each covers in the pixel.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace jaggies_lesson

Demo demo_jaggies() {
  return {"jaggies", "staircases at edges, and 8, 16 and 256 samples per pixel", jaggies_lesson::make};
}

}  // namespace zoneplate::lessons
