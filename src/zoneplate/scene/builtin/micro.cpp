// SPDX-License-Identifier: Apache-2.0
// A wavy sheet of 4,000,000 triangles that covers a 16:9 image: triangles smaller than pixels.
#include <cmath>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/angle.h"
#include "zoneplate/scene/builtin/bench.h"

namespace zoneplate {
namespace micro_scene {
namespace {

constexpr float quarter_pi = 0.78539816f;

float height(float x, float y) { return 0.035f * bumps(x * 1.3f, y * 1.3f, 0.37f); }

Scene make(std::span<const std::int64_t>) {
  constexpr int nx = 2000, ny = 1000;
  constexpr std::size_t columns = nx + 1, rows = ny + 1;
  constexpr float step = 0.002f;
  const SineCosine half_fov = sine_cosine(static_cast<double>(quarter_pi * 0.5f));
  const float half_height = 2.0f * static_cast<float>(half_fov.sine / half_fov.cosine) * 1.06f;
  const float half_width = half_height * 16.0f / 9.0f;

  BenchMesh out(columns * rows, std::size_t{6} * nx * ny);
  parallel_ranges(rows, 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      for (std::size_t i = 0; i < columns; ++i) {
        const auto fi = static_cast<float>(i), fj = static_cast<float>(j);
        const float x = (2.0f * fi / nx - 1.0f) * half_width, y = (2.0f * fj / ny - 1.0f) * half_height;
        const float z = height(x, y);
        const float3 n{(z - height(x + step, y)) / step, (z - height(x, y + step)) / step, 1};
        out.mesh.position[j * columns + i] = {x, y, z};
        out.mesh.normal[j * columns + i] = n * (1 / std::sqrt(dot(n, n)));
        out.mesh.uv0[j * columns + i] = {fi / nx, fj / ny};
      }
  });
  fill_grid(out.mesh.index, 0, nx, ny);
  Scene scene = lit_scene("micro", std::move(out.mesh),
                          {.base = {0.35f, 0.55f, 0.75f}, .light = {0.5f, 0.4f, 0.76811457f}, .double_sided = true});
  scene.cameras.push_back(camera_at({0, 0, 2}, {0, 0, 0}, quarter_pi, 0.5f, 10));
  return scene;
}

}  // namespace
}  // namespace micro_scene

BuiltinMaker builtin_micro() {
  return {"micro", "benchmark: a wavy sheet of 4,000,000 triangles", {}, micro_scene::make};
}

}  // namespace zoneplate
