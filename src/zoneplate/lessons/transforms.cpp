// SPDX-License-Identifier: Apache-2.0
// The transforms from a model to pixels: one point through all spaces, by the renderer's own matrices.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/diagram.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/math/angle.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/make.h"

namespace zoneplate::lessons {
namespace transforms_lesson {
namespace {

using sdf::Point;

/// A house: a box with a ridge, in metres; the ridge's front end is the point that the figure follows.
constexpr std::array<float3, 10> house = {{{-1, 0, 1.5f},
                                           {1, 0, 1.5f},
                                           {1, 1.2f, 1.5f},
                                           {-1, 1.2f, 1.5f},
                                           {0, 2, 1.5f},
                                           {-1, 0, -1.5f},
                                           {1, 0, -1.5f},
                                           {1, 1.2f, -1.5f},
                                           {-1, 1.2f, -1.5f},
                                           {0, 2, -1.5f}}};
constexpr std::size_t ridge = 4;
constexpr std::array<std::array<std::size_t, 2>, 17> edges = {{{0, 1},
                                                               {1, 2},
                                                               {2, 4},
                                                               {4, 3},
                                                               {3, 0},
                                                               {5, 6},
                                                               {6, 7},
                                                               {7, 9},
                                                               {9, 8},
                                                               {8, 5},
                                                               {0, 5},
                                                               {1, 6},
                                                               {2, 7},
                                                               {3, 8},
                                                               {4, 9},
                                                               {2, 3},
                                                               {7, 8}}};
constexpr int image_width = 640, image_height = 480;
constexpr Param params[] = {
    {.name = "turn", .meaning = "of the house, in radians", .value = 0.6, .low = -3.14, .high = 3.14, .decimals = 2},
    {.name = "angle", .meaning = "of view, in radians", .value = 0.5, .low = 0.3, .high = 1.2, .decimals = 2},
    {.name = "near", .meaning = "distance of the near plane", .value = 2.5, .low = 0.1, .high = 6, .decimals = 1},
    {.name = "far", .meaning = "distance of the far plane", .value = 13, .low = 9, .high = 30, .decimals = 1},
};

struct Stages {
  float4x4 world_from_object, camera_from_world, clip_from_camera;
  Camera camera;
};

Stages stages(const Settings& settings) {
  const auto value = [&](const char* name) { return static_cast<float>(settings.number(name)); };
  Stages s;
  s.world_from_object = translation({1.2f, 0, -1}) * rotation({0, 1, 0}, value("turn"));
  s.camera = camera_at({-2.4f, 2.6f, 6.5f}, {1.1f, 0.9f, -0.8f}, value("angle"), value("near"), value("far"));
  s.camera_from_world = inverse(s.camera.world_from_camera);
  s.clip_from_camera = s.camera.clip_from_camera(static_cast<float>(image_width) / image_height);
  return s;
}

/// A drawing area with axes: the point `low` is at the lower left, y points upwards.
struct Chart {
  int side;
  Point low, high;
  Diagram diagram{side, side};

  double unit() const { return side / 360.0; }
  Point at(Point p) const {
    constexpr double margin = 0.09;
    const double inner = side * (1 - 2 * margin), scale = inner / std::max(high.x - low.x, high.y - low.y);
    const Point middle = (low + high) * 0.5;
    return {side / 2.0 + (p.x - middle.x) * scale, side / 2.0 - (p.y - middle.y) * scale};
  }
  void axes(Point origin, double size, const char* x, const char* y) {
    diagram.arrow(at(origin), at(origin + Point{size, 0}), 1.6 * unit(), hue::grey);
    diagram.arrow(at(origin), at(origin + Point{0, size}), 1.6 * unit(), hue::grey);
    diagram.text(at(origin + Point{size, 0}) + Point{10 * unit(), 0}, x, 15 * unit(), hue::grey);
    diagram.text(at(origin + Point{0, size}) + Point{0, -11 * unit()}, y, 15 * unit(), hue::grey);
  }
  template <class Map>
  void wires(const Map& map, Rgba8 color) {
    for (const auto& [a, b] : edges) diagram.line(at(map(house[a])), at(map(house[b])), 1.6 * unit(), color);
  }
  void mark(Point p, Point label = {12, -9}) {
    diagram.dot(at(p), 4.5 * unit(), hue::vermilion);
    diagram.text(at(p) + label * unit(), "P", 17 * unit(), hue::vermilion);
  }
};

std::string triple(float3 p) { return fmt::format("({}, {}, {})", number(p.x, 2), number(p.y, 2), number(p.z, 2)); }

Panel object_panel(int side) {
  Chart chart{side, {-2.2, -1.5}, {2.8, 3}};
  // An oblique view of the model's axes: z points to the lower left.
  const auto oblique = [](float3 p) {
    return Point{static_cast<double>(p.x) - 0.38 * static_cast<double>(p.z),
                 static_cast<double>(p.y) - 0.28 * static_cast<double>(p.z)};
  };
  chart.axes({0, 0}, 2.6, "x", "y");
  chart.diagram.arrow(chart.at({0, 0}), chart.at(oblique({0, 0, 3.2f})), 1.6 * chart.unit(), hue::grey);
  chart.diagram.text(chart.at(oblique({0, 0, 3.6f})), "z", 15 * chart.unit(), hue::grey);
  chart.wires(oblique, hue::blue);
  chart.mark(oblique(house[ridge]), {-13, -9});
  return {chart.diagram.take(), "Object space\nThe model's own coordinates. P = " + triple(house[ridge])};
}

/// From above: x to the right, z downwards, with the camera's field of view between the near and the far plane.
Panel world_panel(int side, const Stages& s) {
  Chart chart{side, {-8, -8.5}, {8, 8}};
  const auto plan = [](float3 p) { return Point{static_cast<double>(p.x), -static_cast<double>(p.z)}; };
  chart.axes({-6.5, 5.2}, 1.9, "x", "−z");
  const double tangent = static_cast<double>(s.clip_from_camera.column[0].x), wide = 1 / tangent;
  const auto from_camera = [&](double x, double z) {
    return plan(transform_point(s.camera.world_from_camera, {static_cast<float>(x), 0, static_cast<float>(z)}));
  };
  const double near = static_cast<double>(s.camera.near), far = static_cast<double>(s.camera.far);
  const Point a = from_camera(-wide * near, -near), b = from_camera(wide * near, -near),
              c = from_camera(wide * far, -far), d = from_camera(-wide * far, -far), eye = from_camera(0, 0);
  const Point frustum[] = {chart.at(a), chart.at(b), chart.at(c), chart.at(d)};
  chart.diagram.polygon(frustum, faded(hue::orange, 50));
  for (std::size_t i = 0; i < 4; ++i)
    chart.diagram.line(frustum[i], frustum[(i + 1) % 4], 1.5 * chart.unit(), hue::orange);
  for (const Point p : {a, b}) chart.diagram.dashed(chart.at(eye), chart.at(p), 1.2 * chart.unit(), hue::orange);
  chart.diagram.dot(chart.at(eye), 4 * chart.unit(), hue::orange);
  chart.diagram.text(chart.at(eye) + Point{0, 15 * chart.unit()}, "camera", 14 * chart.unit(), hue::ink);
  const auto in_world = [&](float3 p) { return plan(transform_point(s.world_from_object, p)); };
  chart.wires(in_world, hue::blue);
  chart.mark(in_world(house[ridge]), {17, 4});
  const float3 world = transform_point(s.world_from_object, house[ridge]),
               camera = transform_point(s.camera_from_world, world);
  return {chart.diagram.take(),
          fmt::format("World, from above\nThe model matrix places the house, the view matrix puts the camera at "
                      "the origin. P = {} in the world, {} seen from the camera.",
                      triple(world), triple(camera))};
}

Panel clip_panel(int side, const Stages& s, float4 clip) {
  Chart chart{side, {-1.25, -1.25}, {1.25, 1.25}};
  const Point box[] = {chart.at({-1, -1}), chart.at({1, -1}), chart.at({1, 1}), chart.at({-1, 1})};
  chart.diagram.polygon(box, faded(hue::orange, 40));
  for (std::size_t i = 0; i < 4; ++i) chart.diagram.line(box[i], box[(i + 1) % 4], 1.5 * chart.unit(), hue::orange);
  chart.diagram.line(chart.at({-1, 0}), chart.at({1, 0}), chart.unit(), hue::light);
  chart.diagram.line(chart.at({0, -1}), chart.at({0, 1}), chart.unit(), hue::light);
  for (const double v : {-1.0, 1.0}) {
    chart.diagram.text(chart.at({v, -1}) + Point{0, 14 * chart.unit()}, v < 0 ? "−1" : "1", 14 * chart.unit(),
                       hue::grey);
    chart.diagram.text(chart.at({-1, v}) + Point{-13 * chart.unit(), 0}, v < 0 ? "−1" : "1", 14 * chart.unit(),
                       hue::grey);
  }
  const auto project = [&](float3 p) {
    const float4 c = s.clip_from_camera * (s.camera_from_world * (s.world_from_object * float4{p.x, p.y, p.z, 1}));
    return Point{static_cast<double>(c.x / c.w), static_cast<double>(c.y / c.w)};
  };
  chart.wires(project, hue::blue);
  chart.mark(project(house[ridge]));
  return {chart.diagram.take(),
          fmt::format(
              "Normalised device coordinates\nThe projection gives P = ({}, {}, {}, {}); divided by w = {} it is {}.",
              number(clip.x, 2), number(clip.y, 2), number(clip.z, 2), number(clip.w, 2), number(clip.w, 2),
              triple({clip.x / clip.w, clip.y / clip.w, clip.z / clip.w}))};
}

/// The wires over the renderer's image of the same house.
Panel viewport_panel(int side, const Stages& s, float4 clip) {
  Chart chart{side, {-60, -300}, {700, 300}};
  const auto to_pixel = [&](float4 c) {
    return Point{(static_cast<double>(c.x / c.w) + 1) / 2 * image_width,
                 (1 - static_cast<double>(c.y / c.w)) / 2 * image_height};
  };
  const auto place = [](Point pixel) { return Point{pixel.x, image_height / 2.0 - pixel.y}; };
  const Point box[] = {chart.at(place({0, 0})), chart.at(place({image_width, 0})),
                       chart.at(place({image_width, image_height})), chart.at(place({0, image_height}))};
  chart.diagram.polygon(box, {51, 51, 51, 255});
  for (const auto& [a, b] : edges) {
    const auto of = [&](std::size_t i) {
      const float3 p = house[i];
      return chart.at(place(
          to_pixel(s.clip_from_camera * (s.camera_from_world * (s.world_from_object * float4{p.x, p.y, p.z, 1})))));
    };
    chart.diagram.line(of(a), of(b), 1.8 * chart.unit(), hue::sky);
  }
  const Point p = to_pixel(clip);
  chart.diagram.dot(chart.at(place(p)), 4.5 * chart.unit(), hue::vermilion);
  chart.diagram.text(chart.at(place(p)) + Point{12 * chart.unit(), -9 * chart.unit()}, "P", 17 * chart.unit(),
                     hue::white);
  chart.diagram.arrow(chart.at(place({0, 0})), chart.at(place({110, 0})), 1.8 * chart.unit(), hue::orange);
  chart.diagram.arrow(chart.at(place({0, 0})), chart.at(place({0, 110})), 1.8 * chart.unit(), hue::orange);
  chart.diagram.text(chart.at(place({60, -26})), "x", 15 * chart.unit(), hue::grey);
  chart.diagram.text(chart.at(place({-26, 60})), "y", 15 * chart.unit(), hue::grey);
  return {chart.diagram.take(),
          fmt::format("Viewport\n{} × {} pixels with y downwards: P is at ({}, {}), in pixel ({}, {}).", image_width,
                      image_height, number(p.x, 1), number(p.y, 1), number(std::floor(p.x), 0),
                      number(std::floor(p.y), 0))};
}

/// The rows of a matrix as a table.
Table matrix_table(const float4x4& m, const char* name) {
  Table table{.head = {name, "", "", ""}, .rows = {}};
  for (int row = 0; row < 4; ++row) {
    std::vector<std::string> cells;
    for (const float4& column : m.column) {
      const float v = row == 0 ? column.x : row == 1 ? column.y : row == 2 ? column.z : column.w;
      cells.push_back(number(v, 3));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel;
  const Stages s = stages(settings);
  const float3 p = house[ridge];
  const float4 clip = s.clip_from_camera * (s.camera_from_world * (s.world_from_object * float4{p.x, p.y, p.z, 1}));
  Figure figure{.title = "Transforms: a point on its way from the model to the image", .rows = {{}, {}}};
  figure.rows[0] = {object_panel(side), world_panel(side, s), clip_panel(side, s, clip), viewport_panel(side, s, clip)};
  Lesson lesson;
  constexpr float half_width = image_width / 2.0f, half_height = image_height / 2.0f;
  const float4x4 viewport = translation({half_width, half_height, 0}) * scaling({half_width, -half_height, 1});
  const std::pair<const float4x4&, const char*> matrices[] = {{s.world_from_object, "Model"},
                                                              {s.camera_from_world, "View"},
                                                              {s.clip_from_camera, "Projection"},
                                                              {viewport, "Viewport"}};
  for (const auto& [matrix, name] : matrices) {
    lesson.tables.push_back(matrix_table(matrix, name));
    figure.rows[1].push_back({table_picture(lesson.tables.back(), size.style(), side), ""});
  }
  figure.text =
      "Matrices act on column vectors (x, y, z, 1): clip = projection · view · model · P. The projection puts the "
      "distance "
      "along the view axis into w, so that the division by w makes far things small. Depth z/w is 1 at the near plane "
      "and 0 "
      "at the far one (reversed), which spreads the precision of floating point evenly.";
  lesson.frames = {figure};
  return lesson;
}

}  // namespace
}  // namespace transforms_lesson

Demo demo_transforms() {
  return {"transforms", "model, view, projection and viewport: one point through all of them", transforms_lesson::make,
          transforms_lesson::params};
}

}  // namespace zoneplate::lessons
