// SPDX-License-Identifier: Apache-2.0
// Shading frequency: lights evaluated once a triangle, at vertices, or at every fragment, on meshes of three
// resolutions.
#include <fmt/format.h>

#include <vector>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/lit_ball.h"
#include "zoneplate/lessons/picture.h"

namespace zoneplate::lessons {
namespace shading_frequency_lesson {
namespace {

struct Resolution {
  int columns, rows;
};
constexpr Resolution resolutions[] = {{8, 6}, {20, 14}, {64, 44}}, reference{256, 180};

struct Frequency {
  ShadingFrequency frequency;
  const char *name, *meaning;
};
constexpr Frequency frequencies[] = {
    {ShadingFrequency::Triangle, "Flat", "One colour for each triangle, from the normal of its plane"},
    {ShadingFrequency::Vertex, "Gouraud", "Colours at the vertices, interpolated over the triangle"},
    {ShadingFrequency::Fragment, "Phong", "Normals interpolated, a colour for each pixel"}};

Material shiny() {
  Material m;
  m.model = ShadingModel::BlinnPhong;
  m.base_color = {0.1f, 0.35f, 0.75f, 1}, m.ambient = {0.1f, 0.35f, 0.75f}, m.specular = {0.6f, 0.6f, 0.6f};
  m.exponent = 60;
  return m;
}

LinearImage ball(const Resolution& resolution, ShadingFrequency frequency, int side) {
  return shoot(lit_ball(shiny(), resolution.columns, resolution.rows), "msaa:n=8", side, side, nullptr, frequency);
}

Lesson make(const DemoSize& size, const Settings&) {
  const Plane<float> exact = luminance_of(ball(reference, ShadingFrequency::Fragment, size.panel));
  Figure figure{.title = "Shading frequency: where lights are evaluated", .rows = {}};
  for (const Frequency& f : frequencies) {
    std::vector<Panel>& row = figure.rows.emplace_back();
    for (const Resolution& r : resolutions) {
      const LinearImage light = ball(r, f.frequency, size.panel);
      const double error = 100 * rms_difference(luminance_of(light), exact);
      row.push_back({shown(light), fmt::format("{}, {} triangles\n{}. Error: {}\u00a0% of white.", f.name,
                                               counted(static_cast<std::uint64_t>(2 * r.columns * (r.rows - 1))),
                                               f.meaning, number(error, 2))});
    }
  }
  figure.text =
      "The light and the normals at the vertices are the same in all nine images. Flat shading shows every triangle. "
      "Gouraud shading loses a highlight that lies between vertices, and turns one on a vertex into a star. Phong "
      "shading needs a fine mesh for the outline alone. The finer the mesh, the less they differ: triangles that are "
      "as "
      "small as pixels make the three equal. (Errors against a mesh of 91,648 triangles with Phong shading, root mean "
      "square of linear light.) The option is --shading-frequency flat|gouraud|phong.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace shading_frequency_lesson

Demo demo_shading_frequency() {
  return {"shading-frequency", "flat, Gouraud and Phong shading on three meshes", shading_frequency_lesson::make};
}

}  // namespace zoneplate::lessons
