// SPDX-License-Identifier: Apache-2.0
// Interpolation of attributes: weights that are linear on the screen are wrong on a surface in perspective.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/diagram.h"
#include "zoneplate/lessons/picture.h"

namespace zoneplate::lessons {
namespace interpolation_lesson {
namespace {

using sdf::Point;

/// A corner of a square floor: its position in camera space, and its texture coordinates.
struct Corner {
  double x, y, z, u, v;
};
using Square = std::array<Corner, 4>;
constexpr double near = 1.3;  // distance of the near edge
constexpr Param params[] = {{.name = "far",
                             .meaning = "distance of the far edge; that of the near one is 1.3",
                             .value = 4.6,
                             .low = 1.4,
                             .high = 20,
                             .decimals = 1}};

/// The square whose far edge has this distance.
Square square_of(double far) {
  return {{{-0.84, -0.78, -near, 0, 0}, {0.84, -0.78, -near, 1, 0}, {0.84, 2.1, -far, 1, 1}, {-0.84, 2.1, -far, 0, 1}}};
}
constexpr std::array<std::array<std::size_t, 3>, 2> triangles = {{{0, 1, 2}, {0, 2, 3}}};
constexpr double focal = 1.45;  // half of the image's height, at distance 1, is 1 / focal
constexpr int checks = 8;
constexpr int plot_width = 480;  // for which the letters of the plot are designed

struct Uv {
  double u = 0, v = 0;
};

/// The projection to pixels of a square image.
Point project(const Corner& c, int side) {
  return {(0.5 + 0.5 * focal * c.x / -c.z) * side, (0.5 - 0.5 * focal * c.y / -c.z) * side};
}

/// Barycentric coordinates of a pixel in a triangle on the screen; negative outside.
std::array<double, 3> barycentric(const std::array<Point, 3>& t, Point p) {
  const double area = cross(t[1] - t[0], t[2] - t[0]);
  return {cross(t[2] - t[1], p - t[1]) / area, cross(t[0] - t[2], p - t[2]) / area,
          cross(t[1] - t[0], p - t[0]) / area};
}

/// The texture coordinates at a pixel, or none outside of the square.
std::optional<Uv> interpolated(const Square& corners, Point p, int side, bool is_perspective) {
  for (const auto& indices : triangles) {
    std::array<Point, 3> t;
    for (std::size_t i = 0; i < 3; ++i) t[i] = project(corners[indices[i]], side);
    std::array<double, 3> w = barycentric(t, p);
    if (*std::ranges::min_element(w) < 0) continue;
    // In perspective, attributes divided by depth are linear on the screen, and so is 1 / depth.
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += w[i] /= is_perspective ? -corners[indices[i]].z : 1;
    Uv out;
    for (std::size_t i = 0; i < 3; ++i)
      out.u += w[i] / sum * corners[indices[i]].u, out.v += w[i] / sum * corners[indices[i]].v;
    return out;
  }
  return std::nullopt;
}

/// The point of the square on the ray through a pixel.
Uv exact(const Square& corners, Point p, int side) {
  const double x = (2 * p.x / side - 1) / focal, y = (1 - 2 * p.y / side) / focal;  // the ray (x, y, -1)
  const Corner &a = corners[0], &d = corners[3];
  const double slope = (d.y - a.y) / (d.z - a.z);  // the plane's y is a.y + slope (z - a.z)
  const double z = (a.y - slope * a.z) / (-y - slope);
  return {(-x * z - a.x) / (corners[1].x - a.x), (z - a.z) / (d.z - a.z)};
}

struct View {
  Rgba8Image image;
  double greatest = 0;  ///< error of u or v
};

View view_of(const Square& corners, int side, bool is_perspective) {
  constexpr int grid = 4;
  LinearImage light(side, side, Linear{1, 1, 1, 1});
  double greatest = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      Linear sum{0, 0, 0, 0};
      for (int k = 0; k < grid * grid; ++k) {
        const Point p{x + (k % grid + 0.5) / grid, y + (k / grid + 0.5) / grid};
        const std::optional<Uv> uv = interpolated(corners, p, side, is_perspective);
        Linear c{1, 1, 1, 1};
        if (uv) {
          const Uv e = exact(corners, p, side);
          greatest = std::max({greatest, std::abs(uv->u - e.u), std::abs(uv->v - e.v)});
          const int i = static_cast<int>(uv->u * checks), j = static_cast<int>(uv->v * checks);
          c = (i + j) % 2 == 0 ? Linear{0.0f, 0.17f, 0.45f, 1} : Linear{0.93f, 0.87f, 0.72f, 1};
        }
        sum = sum + c * (1.0f / (grid * grid));
      }
      light(x, y) = sum;
    }
  return {shown(light), greatest};
}

/// v along the vertical line through the middle of the image.
Plot plot_of(const Square& corners, int side) {
  Plot plot{.title = "",
            .x = {"height above the near edge (pixels)"},
            .y = {"texture coordinate v", 0, 1},
            .curves = {{.name = "affine", .points = {}}, {.name = "perspective-correct", .points = {}}}};
  const double column = 0.45 * side, bottom = project(corners[0], side).y;
  for (int y = side; y-- > 0;) {
    const Point p{column, y + 0.5};
    const auto affine = interpolated(corners, p, side, false), perspective = interpolated(corners, p, side, true);
    if (!affine || !perspective) continue;
    plot.curves[0].points.emplace_back(bottom - p.y, affine->v);
    plot.curves[1].points.emplace_back(bottom - p.y, perspective->v);
  }
  return plot;
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel;
  const double far = settings.number("far");
  const Square corners = square_of(far);
  const View affine = view_of(corners, side, false), perspective = view_of(corners, side, true);
  Figure figure{.title = "Interpolation: weights on the screen are not weights on the surface", .rows = {{}}};
  figure.rows[0].push_back(
      {affine.image,
       fmt::format("Affine\nTexture coordinates are interpolated linearly on the screen. The squares bend "
                   "along the diagonal; u or v is wrong by up to {}.",
                   number(affine.greatest, 2))});
  figure.rows[0].push_back(
      {perspective.image, fmt::format("Perspective-correct\nu/w, v/w and 1/w are interpolated linearly, then divided. "
                                      "Compared with the points where rays meet the plane, u and v differ by at most "
                                      "{:.0e}.",
                                      perspective.greatest)});
  figure.rows[0].push_back(plot_panel(plot_of(corners, side), side, side,
                                      "Along a column\nAn affine v rises at a constant rate; the correct one rises "
                                      "faster towards the horizon, where squares are smaller.",
                                      plot_width));
  figure.text = fmt::format(
      "A projection keeps straight lines but not distances along them: the middle of an edge on the screen is not the "
      "middle of the edge in space. With barycentric coordinates α, β, γ on the screen and the depths of the vertices "
      "z, "
      "an attribute I is (α I/z + β I/z + γ I/z) / (α/z + β/z + γ/z), each term with its own vertex. The square is "
      "made of two triangles; its far edge is {} times as far as the near one.",
      number(far / near, 1));
  return {.frames = {figure}};
}

}  // namespace
}  // namespace interpolation_lesson

Demo demo_interpolation() {
  return {"interpolation", "affine and perspective-correct texture coordinates, against ray-plane intersections",
          interpolation_lesson::make, interpolation_lesson::params};
}

}  // namespace zoneplate::lessons
