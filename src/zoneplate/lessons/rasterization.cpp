// SPDX-License-Identifier: Apache-2.0
// Rasterization: which samples a triangle covers, and which triangle owns a sample on a shared edge.
//
// The coverage is the renderer's: an orthographic camera shows one unit per pixel, so that vertices and samples of the
// drawing are those of the image.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/diagram.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/scene/builtin/make.h"

namespace zoneplate::lessons {
namespace rasterization_lesson {
namespace {

using sdf::Point;
using Triangle = std::array<Point, 3>;

constexpr int columns = 12, rows = 9;
constexpr Param params[] = {
    {.name = "x", .meaning = "moves the triangles, in pixels", .value = 0, .low = -1.5, .high = 1.5, .decimals = 2},
    {.name = "y", .meaning = "moves the triangles, in pixels", .value = 0, .low = -0.75, .high = 0.75, .decimals = 2},
};

/// The triangles of the figure, moved by a part of a pixel.
struct Triangles {
  Triangle one = {{{1.7, 7.6}, {10.6, 5.2}, {4.4, 0.9}}};
  // A square whose sides and diagonal run through centres of pixels.
  Triangle lower = {{{3.5, 1.5}, {3.5, 7.5}, {9.5, 7.5}}}, upper = {{{3.5, 1.5}, {9.5, 7.5}, {9.5, 1.5}}};

  explicit Triangles(Point by) {
    for (Triangle* const triangle : {&one, &lower, &upper})
      for (Point& p : *triangle) p = p + by;
  }
};

/// The number of triangles that cover each sample: each adds half of the light that is left.
Plane<int> covered(std::span<const Triangle> triangles, EdgeRule rule) {
  Scene scene;
  Material glass;
  glass.model = ShadingModel::Unlit;
  glass.alpha_mode = AlphaMode::Blend;
  glass.base_color.w = 0.5f;
  glass.double_sided = true;
  scene.materials = {glass};
  for (const Triangle& t : triangles) {
    Mesh mesh;
    for (const Point& p : t) {
      mesh.position.push_back({static_cast<float>(p.x), static_cast<float>(rows - p.y), 0});
      mesh.normal.push_back({0, 0, 1});
    }
    mesh.index = {0, 1, 2};
    add_object(scene, "triangle", std::move(mesh));
  }
  Camera camera;
  camera.is_orthographic = true, camera.half_height = rows / 2.0f;
  camera.near = 1, camera.far = 3, camera.world_from_camera = translation({columns / 2.0f, rows / 2.0f, 2});
  const Frame frame = render(PreparedScene(scene), camera, {}, {.width = columns, .height = rows, .edge_rule = rule});
  Plane<int> counts(columns, rows);
  for (std::size_t i = 0; i < counts.values().size(); ++i) {
    const float alpha = frame.color.values()[i].a;
    counts.values()[i] = alpha == 0 ? 0 : alpha == 0.5f ? 1 : 2;
  }
  return counts;
}

double edge_function(Point a, Point b, Point p) { return cross(b - a, p - a); }

/// The grid of pixels at this size, and points in it.
struct Grid {
  int width;
  double cell = static_cast<double>(width) / columns;

  int height() const { return static_cast<int>(cell * rows + 0.5); }
  Point at(Point p) const { return p * cell; }
  Point centre(int x, int y) const { return at({x + 0.5, y + 0.5}); }
  double unit() const { return width / 360.0; }  // widths of lines

  void cells(Diagram& d) const {
    for (int x = 0; x <= columns; ++x) d.line(at({x + 0.0, 0}), at({x + 0.0, rows + 0.0}), unit(), hue::light);
    for (int y = 0; y <= rows; ++y) d.line(at({0, y + 0.0}), at({columns + 0.0, y + 0.0}), unit(), hue::light);
  }
  void tint(Diagram& d, int x, int y, Rgba8 color) const {
    d.fill(sdf::moved(centre(x, y), sdf::rectangle(cell, cell)), color);
  }
  void outline(Diagram& d, const Triangle& t, Rgba8 color) const {
    for (std::size_t i = 0; i < 3; ++i) d.line(at(t[i]), at(t[(i + 1) % 3]), 2.2 * unit(), color);
  }
};

Panel coverage_panel(const Grid& grid, const Triangle& triangle, const Plane<int>& counts) {
  Diagram d(grid.width, grid.height());
  int inside = 0, different = 0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      if (counts(x, y) > 0) grid.tint(d, x, y, faded(hue::sky, 150));
      inside += counts(x, y) > 0;
    }
  grid.cells(d);
  grid.outline(d, triangle, hue::ink);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const Point p{x + 0.5, y + 0.5};
      bool is_in = true;
      for (std::size_t i = 0; i < 3; ++i) is_in &= edge_function(triangle[i], triangle[(i + 1) % 3], p) < 0;
      different += is_in != (counts(x, y) > 0);
      if (counts(x, y) > 0)
        d.dot(grid.centre(x, y), 3.2 * grid.unit(), hue::blue);
      else
        d.circle(grid.centre(x, y), 2.6 * grid.unit(), 1.2 * grid.unit(), hue::grey);
    }
  return {d.take(),
          fmt::format("Sampling\nA pixel is covered if the triangle contains its centre: {} of {} pixels. The "
                      "renderer and the edge functions differ at {} samples.",
                      inside, columns * rows, different)};
}

Panel edge_panel(const Grid& grid, const Triangle& triangle) {
  Diagram d(grid.width, grid.height());
  constexpr Rgba8 colors[] = {hue::vermilion, hue::green, hue::blue};
  const Point inside[] = {grid.at(triangle[0]), grid.at(triangle[1]), grid.at(triangle[2])};
  d.polygon(inside, faded(hue::sky, 90));
  constexpr const char* names[] = {"A", "B", "C"};
  const Point middle = (triangle[0] + triangle[1] + triangle[2]) * (1.0 / 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const Point a = triangle[i], b = triangle[(i + 1) % 3], along = (b - a) * (1 / length(b - a));
    d.dashed(grid.at(a - along * 14), grid.at(a), 1.2 * grid.unit(), colors[i]);
    d.dashed(grid.at(b), grid.at(b + along * 14), 1.2 * grid.unit(), colors[i]);
    d.arrow(grid.at(a), grid.at(b), 2.4 * grid.unit(), colors[i]);
    const Point half = (a + b) * 0.5, inward{along.y, -along.x};
    d.text(grid.at(half + inward * 0.8), "+", 19 * grid.unit(), colors[i]);
    d.text(grid.at(half - inward * 0.8), "−", 19 * grid.unit(), colors[i]);
    const Point out = a - middle;
    d.text(grid.at(a + out * (0.75 / length(out))), names[i], 17 * grid.unit(), hue::ink);
  }
  const Point p{5.5, 4.5};
  d.dot(grid.at(p), 3.4 * grid.unit(), hue::ink);
  d.text(grid.at(p + Point{0.55, 0.1}), "P", 17 * grid.unit(), hue::ink);
  std::array<double, 3> e{};
  double area = 0;
  for (std::size_t i = 0; i < 3; ++i) area += e[i] = -edge_function(triangle[i], triangle[(i + 1) % 3], p);
  return {
      d.take(),
      fmt::format("Edge functions\nE(A, B, P) is twice the signed area of the triangle ABP, and P is inside where all "
                  "three are positive. At P they are {}, {} and {}; divided by their sum, {}, they are its "
                  "barycentric coordinates.",
                  number(e[0], 1), number(e[1], 1), number(e[2], 1), number(area, 1))};
}

/// Two triangles that share a diagonal.
Panel shared_panel(const Grid& grid, const Triangles& triangles, EdgeRule rule) {
  const auto& [unused, lower, upper] = triangles;
  const Triangle both[] = {lower, upper};
  const Plane<int> counts = covered(both, rule), first = covered({both, 1}, rule);
  Diagram d(grid.width, grid.height());
  int once = 0, twice = 0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const int n = counts(x, y);
      once += n == 1, twice += n == 2;
      if (n == 0) continue;
      grid.tint(d, x, y, faded(n == 2 ? hue::vermilion : first(x, y) > 0 ? hue::sky : hue::orange, 130));
    }
  grid.cells(d);
  grid.outline(d, lower, hue::blue);
  grid.outline(d, upper, hue::ink);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      if (counts(x, y) == 0)
        d.circle(grid.centre(x, y), 2.6 * grid.unit(), 1.2 * grid.unit(), hue::grey);
      else
        d.dot(grid.centre(x, y), 3.2 * grid.unit(),
              counts(x, y) == 2 ? hue::vermilion
              : first(x, y) > 0 ? hue::blue
                                : hue::ink);
    }
  const bool is_top_left = rule == EdgeRule::TopLeft;
  return {d.take(),
          fmt::format("{}\n{} samples are covered once, {} twice.{}",
                      is_top_left ? "Top-left rule" : "Every triangle owns its edges", once, twice,
                      is_top_left ? " A sample on an edge belongs to the triangle on whose left side, or horizontal "
                                    "upper side, it is."
                                  : " Transparent triangles would show these seams.")};
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const Grid grid{size.panel};
  Figure figure{.title = "Rasterization: a triangle covers the samples that it contains", .rows = {{}}};
  const Triangles triangles({settings.number("x"), settings.number("y")});
  const Triangle one[] = {triangles.one};
  figure.rows[0].push_back(coverage_panel(grid, triangles.one, covered(one, EdgeRule::TopLeft)));
  figure.rows[0].push_back(edge_panel(grid, triangles.one));
  figure.rows[0].push_back(shared_panel(grid, triangles, EdgeRule::Inside));
  figure.rows[0].push_back(shared_panel(grid, triangles, EdgeRule::TopLeft));
  figure.text =
      "Only the pixels of the bounding box are tested, and the edge functions change by a constant from pixel to "
      "pixel. "
      "Where two triangles share an edge that runs through a sample, the sample must belong to exactly one of them: "
      "with "
      "neither there would be a hole, with both a transparent surface is blended twice. The coverage in these images "
      "is "
      "the renderer's own (--edge-rule).";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace rasterization_lesson

Demo demo_rasterization() {
  return {"rasterization", "samples inside a triangle, edge functions, and the top-left rule",
          rasterization_lesson::make, rasterization_lesson::params};
}

}  // namespace zoneplate::lessons
