// SPDX-License-Identifier: Apache-2.0
// Exact coverage: the error of sample grids at edges, measured against exact areas.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"

namespace zoneplate::lessons {
namespace exact_coverage_lesson {
namespace {

constexpr int factor = 8;
constexpr float gain = 8;  // brightness factor of error maps

struct Grid {
  const char* method;
  int n;
};
constexpr std::array<Grid, 3> grids = {{{"ssaa:n=2", 2}, {"ssaa:n=4", 4}, {"ssaa:n=8", 8}}};

/// The differences between an image and the exact one.
struct Errors {
  Plane<float> map;  ///< the greatest difference of a channel, in linear light, times the gain
  double rms = 0;    ///< over the pixels that contain more than one surface
};

Errors errors_of(const LinearImage& picture, const LinearImage& exact, const LinearImage& centres) {
  Errors out{Plane<float>(exact.width(), exact.height()), 0};
  double squares = 0;
  int shared = 0;
  for (std::size_t i = 0; i < exact.values().size(); ++i) {
    const Linear p = picture.values()[i], q = exact.values()[i];
    const std::array<float, 3> off = {p.r - q.r, p.g - q.g, p.b - q.b};
    float greatest = 0;
    for (const float d : off) greatest = std::max(greatest, std::abs(d));
    out.map.values()[i] = gain * greatest;
    if (q == centres.values()[i]) continue;
    for (const float d : off) squares += static_cast<double>(d) * d / 3;
    ++shared;
  }
  out.rms = std::sqrt(squares / shared);
  return out;
}

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, height = side * 3 / 4;
  const Scene scene = scene_of("crossing");
  const LinearImage exact = shoot(scene, "analytic", side, height), centres = shoot(scene, "none", side, height);

  // The nearly vertical side of the blue square, where it crosses the green one.
  const int x = side * 68 / 100, y = height * 50 / 100;
  Figure figure{.title = "Exact coverage: the area of each surface in a pixel, without sampling", .rows = {{}, {}}};
  double last = 0;
  for (const Grid& grid : grids) {
    const LinearImage picture = shoot(scene, grid.method, side, height);
    const Errors errors = errors_of(picture, exact, centres);
    const std::string fall = last > 0 ? fmt::format(", {} times smaller", number(last / errors.rms, 1)) : "";
    figure.rows[0].push_back({crop_of(shown(picture), x, y, factor, side),
                              fmt::format("{} samples\n--aa {}: a nearly vertical edge has {} steps.", grid.n * grid.n,
                                          grid.method, grid.n)});
    figure.rows[1].push_back({crop_of(shown(errors.map), x, y, factor, side),
                              fmt::format("Its error, {} times brighter. Root mean square along edges: {}\u00a0%{}.",
                                          number(gain, 0), number(100 * errors.rms, 2), fall)});
    last = errors.rms;
  }
  const Rgba8Image exact_picture = shown(exact);
  figure.rows[0].push_back(
      {crop_of(exact_picture, x, y, factor, side), "Exact area\n--aa analytic: coverage without discrete steps."});
  figure.rows[1].push_back(
      {marked(exact_picture, x, y, factor, side), "Three intersecting squares; the frame marks the crops."});
  figure.text =
      "The visible polygons of a pixel are clipped at every edge, and where surfaces intersect; their areas are the "
      "weights of the pixel's colours. Averaged over edges of all directions, the error of a grid falls to 1/2.8 when "
      "its rows double, at four times the cost; it falls less at edges near an axis, where the eye is most sensitive. "
      "A comparison with exact areas is free of sampling noise.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace exact_coverage_lesson

Demo demo_exact_coverage() {
  return {"exact-coverage", "sample grids at edges against exact areas", exact_coverage_lesson::make};
}

}  // namespace zoneplate::lessons
