// SPDX-License-Identifier: Apache-2.0
// Newell's teapot: 32 bicubic Bezier patches, computed from the sections of the original drawing.
//
// The body, the lid and the bottom are four quarter turns about the axis, one patch each; the handle and the spout are
// two mirrored halves. Lengths are Newell's (the lid's knob at 3.15), with his vertical z axis.
//
// Source: Newell, The Utilization of Procedure Models in Digital Image Synthesis, PhD thesis, Utah, 1975, with the
// bottom that was added later; Crow, The Origins of the Teapot, IEEE CG&A 7(1), 1987.
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "zoneplate/scene/builtin/make.h"

namespace zoneplate {
namespace teapot_scene {
namespace {

struct Point {
  double x = 0, y = 0, z = 0;
};
Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator*(Point a, double s) { return {a.x * s, a.y * s, a.z * s}; }
Point cross(Point a, Point b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Control points; u varies along a row, v from row to row; v × u points outwards.
using Patch = std::array<std::array<Point, 4>, 4>;

/// A control ring of a surface of revolution: its radius, the length of its quarter arc's tangents, its height.
struct Ring {
  double radius, arm, height;
};
constexpr Ring rim_and_body[] = {{1.4, 0.784, 2.4}, {1.3375, 0.749, 2.53125}, {1.4375, 0.805, 2.53125},
                                 {1.5, 0.84, 2.4},  {1.75, 0.98, 1.875},      {2, 1.12, 1.35},
                                 {2, 1.12, 0.9},    {2, 1.12, 0.45},          {1.5, 0.84, 0.225},
                                 {1.5, 0.84, 0.15}, {1.5, 0.84, 0.075},       {1.425, 0.798, 0},
                                 {0, 0, 0}};
constexpr Ring lid[] = {{0, 0, 3.15},       {0.8, 0.45, 3.15},  {0, 0, 2.85},     {0.2, 0.112, 2.7},
                        {0.4, 0.224, 2.55}, {1.3, 0.728, 2.55}, {1.3, 0.728, 2.4}};

/// A control section of a tube that is symmetric in y: its two points in the plane y = 0, and its half width.
struct Section {
  double x0, z0, x1, z1, half;
};
constexpr Section handle[] = {{-1.6, 2.025, -1.5, 2.25, 0.3}, {-2.3, 2.025, -2.5, 2.25, 0.3},
                              {-2.7, 2.025, -3, 2.25, 0.3},   {-2.7, 1.8, -3, 1.8, 0.3},
                              {-2.7, 1.575, -3, 1.35, 0.3},   {-2.5, 1.125, -2.65, 0.9375, 0.3},
                              {-2, 0.9, -1.9, 0.6, 0.3}};
constexpr Section spout[] = {{1.7, 1.425, 1.7, 0.6, 0.66},       {2.6, 1.425, 3.1, 0.825, 0.66},
                             {2.3, 2.1, 2.4, 2.025, 0.25},       {2.7, 2.4, 3.3, 2.4, 0.25},
                             {2.8, 2.475, 3.525, 2.49375, 0.25}, {2.9, 2.475, 3.45, 2.5125, 0.15},
                             {2.8, 2.4, 3.2, 2.4, 0.15}};

std::vector<Patch> revolved(std::span<const Ring> rings) {
  std::vector<Patch> patches;
  for (std::size_t first = 0; first + 3 < rings.size(); first += 3)
    for (int quarter = 0; quarter < 4; ++quarter) {
      Patch& patch = patches.emplace_back();
      for (std::size_t i = 0; i < 4; ++i) {
        const auto [r, a, z] = rings[first + i];
        patch[i] = {Point{r, 0, z}, Point{r, a, z}, Point{a, r, z}, Point{0, r, z}};
        for (int turns = 0; turns < quarter; ++turns)
          for (Point& p : patch[i]) p = {-p.y, p.x, p.z};
      }
    }
  return patches;
}

std::vector<Patch> tube(std::span<const Section> sections) {
  std::vector<Patch> patches;
  for (std::size_t first = 0; first + 3 < sections.size(); first += 3) {
    Patch left, right;
    for (std::size_t i = 0; i < 4; ++i) {
      const Section& s = sections[first + i];
      left[i] = {Point{s.x0, 0, s.z0}, Point{s.x0, s.half, s.z0}, Point{s.x1, s.half, s.z1}, Point{s.x1, 0, s.z1}};
      right[i] = {Point{s.x1, 0, s.z1}, Point{s.x1, -s.half, s.z1}, Point{s.x0, -s.half, s.z0}, Point{s.x0, 0, s.z0}};
    }
    patches.push_back(left);
    patches.push_back(right);
  }
  return patches;
}

/// The weights of four control points, and their derivatives, at i/n.
///
/// The weights at n - i are exactly those at i in reverse order, so that adjacent patches agree on their common edge to
/// the last bit, in either direction.
struct Weights {
  std::array<double, 4> value, slope;
};
Weights weights(int i, int n) {
  const double t = static_cast<double>(i) / n, s = static_cast<double>(n - i) / n;
  return {{s * s * s, 3 * (s * s) * t, 3 * (t * t) * s, t * t * t},
          {-3 * (s * s), 3 * (s * s) - 6 * (s * t), 6 * (s * t) - 3 * (t * t), 3 * (t * t)}};
}

Point mix(const std::array<double, 4>& w, const Point& a, const Point& b, const Point& c, const Point& d) {
  return (a * w[0] + d * w[3]) + (b * w[1] + c * w[2]);
}

Point on_patch(const Patch& p, const std::array<double, 4>& u, const std::array<double, 4>& v) {
  std::array<Point, 4> row;
  for (std::size_t i = 0; i < 4; ++i) row[i] = mix(u, p[i][0], p[i][1], p[i][2], p[i][3]);
  return mix(v, row[0], row[1], row[2], row[3]);
}

/// The outward normal; if a ring has radius 0, the limit from the side of the patch (by the mixed derivative).
Point normal_on(const Patch& p, const Weights& u, const Weights& v, bool is_last_row) {
  const Point along_v = on_patch(p, u.value, v.slope);
  Point n = cross(along_v, on_patch(p, u.slope, v.value));
  if (dot(n, n) < 1e-18) n = cross(along_v, on_patch(p, u.slope, v.slope)) * (is_last_row ? -1 : 1);
  return n * (1 / std::sqrt(dot(n, n)));
}

/// Rotated so that +Y is up, and scaled by 1/16: a pot of 20 cm.
float3 placed(Point p) {
  return {static_cast<float>(p.x / 16), static_cast<float>(p.z / 16), static_cast<float>(-p.y / 16)};
}

void add_patch(Mesh& mesh, const Patch& patch, int n) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size()), columns = static_cast<std::uint32_t>(n) + 1;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const Weights u = weights(i, n), v = weights(j, n);
      const Point normal = normal_on(patch, u, v, j == n);
      mesh.position.push_back(placed(on_patch(patch, u.value, v.value)));
      mesh.normal.push_back(
          {static_cast<float>(normal.x), static_cast<float>(normal.z), static_cast<float>(-normal.y)});
      mesh.uv0.push_back(
          {static_cast<float>(i) / static_cast<float>(n), static_cast<float>(j) / static_cast<float>(n)});
    }
  const auto add_triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const float3 pa = mesh.position[a], pb = mesh.position[b], pc = mesh.position[c];
    if (pa == pb || pb == pc || pc == pa) return;  // degenerate at a point of the axis
    for (const std::uint32_t v : {a, b, c}) mesh.index.push_back(v);
  };
  for (std::uint32_t j = 0; j + 1 < columns; ++j)
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t q = first + j * columns + i, r = q + columns;
      add_triangle(q, r, r + 1);
      add_triangle(q, r + 1, q + 1);
    }
}

Mesh part(const std::vector<Patch>& patches, std::int64_t divisions) {
  Mesh mesh;
  for (const Patch& patch : patches) add_patch(mesh, patch, static_cast<int>(divisions));
  return mesh;
}

constexpr Param params[] = {{"divisions", "cells of a patch, per side", 16, 1, 512}};

Scene make(std::span<const std::int64_t> values) {
  Scene scene;
  Material glaze;
  glaze.name = "glaze";
  glaze.double_sided = true;  // the inside is visible through the gap below the lid
  glaze.base_color = {0.74f, 0.26f, 0.10f, 1};
  glaze.metallic = 0;
  glaze.roughness = 0.28f;
  scene.materials.push_back(glaze);
  add_object(scene, "body", part(revolved(rim_and_body), values[0]));
  add_object(scene, "lid", part(revolved(lid), values[0]));
  add_object(scene, "handle", part(tube(handle), values[0]));
  add_object(scene, "spout", part(tube(spout), values[0]));
  return scene;
}

}  // namespace
}  // namespace teapot_scene

BuiltinMaker builtin_teapot() {
  return {"teapot", "Newell's teapot, 32 Bezier patches", teapot_scene::params, teapot_scene::make};
}

}  // namespace zoneplate
