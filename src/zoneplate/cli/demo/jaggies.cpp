// Jaggies: one sample a pixel says all or nothing of an edge; the mean of more says how much.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/cli/demo/demo.h"
#include "zoneplate/cli/demo/picture.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/metrics/mse.h"

namespace zoneplate::cli {
namespace {

constexpr const char* reference = "ssaa:n=16";
constexpr int factor = 8;

struct Way {
  const char *method, *heading, *words;
};
constexpr std::array<Way, 3> ways = {
    {{"none", "One sample", "A pixel is wholly the pot or wholly not: edges become stairs."},
     {"msaa:n=8", "8 samples, shaded once",
      "Coverage is asked 8 times, colour once a surface: smooth outlines at little cost."},
     {"ssaa:n=4", "16 samples, each shaded", "The highlights inside of the outline become smooth too."}}};

Lesson make(const DemoSize& size) {
  const int side = size.panel, height = side * 3 / 4;
  const Scene scene = scene_of("teapot");
  RenderCounts counts;
  const LinearImage truth = shoot(scene, reference, side, height, &counts);
  const DisplayImage truth_display = make_display(truth, {});

  // The right end of the lid and its seat: outlines, a seam, and highlights narrower than a pixel.
  const int x = side * 57 / 100, y = side * 20 / 100;
  Figure figure{.title = "Jaggies: a pixel that is asked once answers all or nothing", .rows = {{}, {}}};
  const auto add = [&](const LinearImage& light, std::string caption, std::string crop_caption) {
    const Rgba8Image picture = shown(light);
    figure.rows[0].push_back({marked(picture, x, y, factor, side), std::move(caption)});
    figure.rows[1].push_back({crop_of(picture, x, y, factor, side), std::move(crop_caption)});
  };
  for (const Way& way : ways) {
    RenderCounts done;
    const LinearImage light = shoot(scene, way.method, side, height, &done);
    const double error = std::sqrt(metrics::mean_squared_error(truth_display, make_display(light, {})));
    add(light, fmt::format("{}\n{}", way.heading, way.words),
        fmt::format("--aa {}\n{} points shaded, error {}\u00a0%.", way.method, counted(done.shaded),
                    number(100 * error, 2)));
  }
  add(truth, "256 samples, the truth\nA 16 × 16 grid in each pixel stands for the area itself.",
      fmt::format("--aa {}\n{} points shaded.", reference, counted(counts.shaded)));
  figure.text =
      "The frames mark what is shown below, 8 times enlarged; the error is the root mean square of the difference from "
      "the last picture, in codes, white being 100 %. No method makes an edge sharper than a pixel: a good one gives "
      "each pixel as much of both sides as it has.";
  return {.frames = {figure}};
}

}  // namespace

Demo demo_jaggies() {
  return {"jaggies", "stairs at edges, and what 8, 16 and 256 samples a pixel make of them", make};
}

}  // namespace zoneplate::cli
