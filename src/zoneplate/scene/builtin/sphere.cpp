// SPDX-License-Identifier: Apache-2.0
// A sphere made from a cube, with noise displacement: any number of triangles of nearly equal size.
#include <cmath>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/angle.h"
#include "zoneplate/scene/builtin/bench.h"

namespace zoneplate {
namespace sphere_scene {
namespace {

/// A side of the cube: its two axes and its normal, their cross product.
struct Side {
  float3 u, v, normal;
};
constexpr Side sides[6] = {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
                           {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                           {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};

/// Normalizes by the reciprocal of the length, as other renderers' versions of the scene do.
float3 unit(float3 a) { return a * (1 / std::sqrt(dot(a, a))); }

float3 displaced(float3 direction) {
  const float r = 1 + 0.045f * bumps(direction.x, direction.y, direction.z);
  return direction * r;
}

/// The normal, from differences along two tangents.
float3 normal_at(float3 direction, float3 position) {
  constexpr float step = 0.002f;
  const float3 reference = std::abs(direction.y) > 0.9f ? float3{1, 0, 0} : float3{0, 1, 0};
  const float3 t = unit(cross(reference, direction)), b = cross(direction, t);
  const float3 along_t = displaced(unit(direction + step * t)) - position;
  const float3 along_b = displaced(unit(direction + step * b)) - position;
  return unit(cross(along_t, along_b));
}

/// The positions of the lines of a side's grid, at equal angles from the centre.
///
/// The second half mirrors the first, so that adjacent sides have the same bits on their common edge.
std::vector<float> grid_lines(int n) {
  std::vector<float> lines(static_cast<std::size_t>(n) + 1);
  for (int i = 0; 2 * i < n; ++i) {
    const float share = 2.0f * static_cast<float>(i) / static_cast<float>(n) - 1;
    const SineCosine a = sine_cosine(static_cast<double>(share * 0.78539816f));
    const float line = i == 0 ? -1 : static_cast<float>(a.sine / a.cosine);
    lines[static_cast<std::size_t>(i)] = line;
    lines[static_cast<std::size_t>(n - i)] = -line;
  }
  return lines;
}

Mesh sphere_mesh(int n) {
  const auto columns = static_cast<std::size_t>(n) + 1;
  const std::vector<float> lines = grid_lines(n);
  BenchMesh out(6 * columns * columns, 36 * (columns - 1) * (columns - 1));
  parallel_for(6 * columns, [&](std::size_t row) {
    const Side& side = sides[row / columns];
    const std::size_t j = row % columns;
    for (std::size_t i = 0; i < columns; ++i) {
      const float3 direction = unit((side.normal + lines[i] * side.u) + lines[j] * side.v);
      const std::size_t at = row * columns + i;
      out.mesh.position[at] = displaced(direction);
      out.mesh.normal[at] = normal_at(direction, out.mesh.position[at]);
      out.mesh.uv0[at] = {static_cast<float>(i) / static_cast<float>(n), static_cast<float>(j) / static_cast<float>(n)};
    }
  });
  const std::size_t of_side = out.mesh.index.size() / 6;
  for (std::size_t f = 0; f < 6; ++f)
    fill_grid(std::span(out.mesh.index).subspan(f * of_side, of_side),
              static_cast<std::uint32_t>(f * columns * columns), n, n);
  return std::move(out.mesh);
}

Scene make_of(const char* name, int n) {
  Scene scene = lit_scene(name, sphere_mesh(n), {});
  // At this distance a unit sphere is 0.6 of the image's height at 45°.
  const float3 eye = unit({0.35f, 0.30f, 1}) * 4.1456f;
  scene.cameras.push_back(camera_at(eye, {0, 0, 0}, 0.78539816f, 1, 10));
  return scene;
}

constexpr Param params[] = {{"triangles", "rounded up to 12 n²", 10000, 12, 100'000'000}};

Scene make_sphere(std::span<const std::int64_t> values) {
  int n = 1;
  while (12 * std::int64_t{n} * n < values[0]) ++n;
  return make_of("sphere", n);
}

}  // namespace
}  // namespace sphere_scene

BuiltinMaker builtin_sphere() {
  return {"sphere", "a sphere displaced by noise, of any number of triangles", sphere_scene::params,
          sphere_scene::make_sphere};
}
BuiltinMaker builtin_tri10k() {
  return {"tri10k", "benchmark: the sphere of 10,092 triangles", {}, [](auto) {
            return sphere_scene::make_of("tri10k", 29);
          }};
}
BuiltinMaker builtin_tri1m() {
  return {"tri1m", "benchmark: the sphere of 1,002,252 triangles", {}, [](auto) {
            return sphere_scene::make_of("tri1m", 289);
          }};
}

}  // namespace zoneplate
