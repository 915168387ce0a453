// SPDX-License-Identifier: Apache-2.0
// Antialiasing over frames: every frame samples another point of the pixel, and the mean of the frames converges.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/lessons/temporal/moving_film.h"
#include "zoneplate/metrics/mse.h"

namespace zoneplate::lessons {
namespace temporal_lesson {
namespace {

constexpr int factor = 8;
constexpr std::array counts = {1, 2, 4, 8, 16, 32};
constexpr std::array shown_counts = {1, 4, 16};
constexpr const char* still = "wires";
constexpr const char* moving = "panning-wires";

struct Cure {
  const char *method, *heading, *words;
};
constexpr std::array<Cure, 3> cures = {
    {{"none", "No history", "Every frame is aliased at other pixels: the wires break into dashes that crawl."},
     {"taa:rectify=none,reject=none,rest=test,bias=0", "History follows the surfaces",
      "Motion moves the history along. Catmull-Rom's filter in every frame blurs it, and falls below both colours "
      "beside "
      "edges: dark lines."},
     {"taa", "History is tested",
      "It must belong to the same surface, and lie among the colours around it: no ghosts, but wires that most frames "
      "miss are clipped away."}}};

double error_of(const LinearImage& reference, const LinearImage& test) {
  return 100 * std::sqrt(metrics::mean_squared_error(make_display(reference, {}), make_display(test, {})));
}

std::string after(int frames) {
  return fmt::format("taa:rectify=none,reject=none,bias=0,alpha=0.001,frames={}", frames);
}

/// The centre of a square crop.
struct Spot {
  int x = 0, y = 0;
};

/// The square of this side in which two images differ most.
Spot worst_spot(const LinearImage& a, const LinearImage& b, int side) {
  Spot worst;
  float most = -1;
  for (int top = 0; top + side <= a.height(); top += 2)
    for (int left = 0; left + side <= a.width(); left += 2) {
      float sum = 0;
      for (int y = top; y < top + side; ++y)
        for (int x = left; x < left + side; ++x) sum += std::abs(a(x, y).g - b(x, y).g);
      if (sum > most) most = sum, worst = {left + side / 2, top + side / 2};
    }
  return worst;
}

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, height = side * 3 / 4;
  const Scene scene = scene_of(still);
  const LinearImage reference = shoot(scene, "ssaa:pattern=halton,samples=256", side, height);
  const Spot spot = worst_spot(reference, shoot(scene, "none", side, height), side / factor);
  Figure figure{.title = "Temporal antialiasing: samples of many frames in one pixel", .rows = {{}, {}}};
  Table table{{"frames", "error"}, {}};
  for (const int count : counts) {
    const LinearImage image =
        count == 1 ? shoot(scene, "none", side, height) : shoot(scene, after(count), side, height);
    const std::string error = number(error_of(reference, image), 2) + "\u00a0%";
    table.rows.push_back({std::to_string(count), error});
    if (std::find(shown_counts.begin(), shown_counts.end(), count) != shown_counts.end())
      figure.rows[0].push_back(
          {crop_of(shown(image), spot.x, spot.y, factor, side),
           fmt::format("A scene at rest: {} frame{}\nError {}.", count, count > 1 ? "s" : "", error)});
  }
  constexpr int frames = 12;
  const LinearImage last = film_of_scene(moving, "ssaa:pattern=halton,samples=64", frames, side, height).back();
  for (const Cure& cure : cures) {
    const LinearImage image = film_of_scene(moving, cure.method, frames, side, height).back();
    figure.rows[1].push_back({crop_of(shown(image), spot.x, spot.y, factor, side),
                              fmt::format("{}, the camera pans\n{} Error {}\u00a0%.", cure.heading, cure.words,
                                          number(error_of(last, image), 2))});
  }
  figure.rows.push_back({{table_picture(table, size.style(), size.panel), ""}});
  figure.text =
      "The sample moves by a Halton sequence of 16 points. Error: root mean square difference from the reference, of "
      "sRGB values, white being 100 %. In a scene at rest it falls as with that many samples in one frame, at the cost "
      "of one; in motion, history is worth less.";
  return {.frames = {figure}, .tables = {table}};
}

}  // namespace
}  // namespace temporal_lesson

Demo demo_temporal() {
  return {"temporal", "one sample a frame, accumulated at rest and in motion", temporal_lesson::make};
}

}  // namespace zoneplate::lessons
