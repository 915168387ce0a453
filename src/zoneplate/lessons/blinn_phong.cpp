// SPDX-License-Identifier: Apache-2.0
// The specular term of Blinn-Phong and Phong: its coefficient scales the highlight, its exponent narrows it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/lit_ball.h"
#include "zoneplate/lessons/picture.h"

namespace zoneplate::lessons {
namespace blinn_phong_lesson {
namespace {

constexpr int columns = 192, rows = 128;

struct Row {
  ShadingModel model;
  const char* name;
  float ks;
};
constexpr Param params[] = {
    {.name = "ks", .meaning = "coefficient of the lower rows", .value = 0.5, .low = 0, .high = 1, .decimals = 2},
    {.name = "p",
     .meaning = "exponent of the first column; four times as large in each next one",
     .value = 4,
     .low = 1,
     .high = 64}};

LinearImage ball(const Row& row, float exponent, int side) {
  Material m;
  m.model = row.model;
  m.base_color = {0.45f, 0.1f, 0.06f, 1}, m.ambient = {0.45f, 0.1f, 0.06f};
  m.specular = {row.ks, row.ks, row.ks}, m.exponent = exponent;
  return shoot(lit_ball(m, columns, rows), "msaa:n=8", side, side);
}

/// The diameter, in per cent of the sphere's, of the disc as large as the part of the highlight above half its peak.
double width_of(const LinearImage& with, const LinearImage& without) {
  const Plane<float> a = luminance_of(with), b = luminance_of(without);
  std::vector<float> highlight(a.values().size());
  std::transform(a.values().begin(), a.values().end(), b.values().begin(), highlight.begin(),
                 [](float x, float y) { return x - y; });
  const float peak = *std::max_element(highlight.begin(), highlight.end());
  const auto above = std::count_if(highlight.begin(), highlight.end(), [&](float x) { return x > peak / 2; });
  constexpr double pi = 3.14159265358979323846, ball = 2 / 2.12;  // of the image's height
  return 100 * std::sqrt(4 * static_cast<double>(above) / pi) / (ball * with.width());
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const LinearImage matt = ball({ShadingModel::BlinnPhong, "", 0}, 1, size.panel);
  Figure figure{.title = "Blinn-Phong: the coefficient scales the highlight, the exponent narrows it", .rows = {}};
  const auto ks = static_cast<float>(settings.number("ks")), p = static_cast<float>(settings.integer("p"));
  const Row lobes[] = {{ShadingModel::BlinnPhong, "Blinn-Phong", 0.15f},
                       {ShadingModel::BlinnPhong, "Blinn-Phong", ks},
                       {ShadingModel::Phong, "Phong", ks}};
  for (const Row& row : lobes) {
    std::vector<Panel>& panels = figure.rows.emplace_back();
    for (const float exponent : {p, 4 * p, 16 * p, 64 * p}) {
      const LinearImage light = ball(row, exponent, size.panel);
      panels.push_back({shown(light), fmt::format("{}, ks = {}, p = {}\nThe highlight is {}\u00a0% as wide as the "
                                                  "sphere, at half its peak.",
                                                  row.name, row.ks, exponent, number(width_of(light, matt), 1))});
    }
  }
  figure.text =
      "The colour is ka ambient + kd max(0, n·l) light + ks max(0, n·h)^p light, with h halfway between the directions "
      "to the light l and to the viewer v. Phong's own term is max(0, r·v)^p, with r the mirror image of l in n: the "
      "angle between r and v is about twice that between n and h, so that its highlights are half as wide at the same "
      "exponent. Large exponents make highlights as small as a pixel, which alias and flicker.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace blinn_phong_lesson

Demo demo_blinn_phong() {
  return {"blinn-phong", "the specular term by coefficient and exponent, and Phong's", blinn_phong_lesson::make,
          blinn_phong_lesson::params};
}

}  // namespace zoneplate::lessons
