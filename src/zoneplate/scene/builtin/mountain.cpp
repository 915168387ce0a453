// SPDX-License-Identifier: Apache-2.0
// A mountain as geometry: a height field of fractal noise.
#include <algorithm>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/scene/builtin/bench.h"
#include "zoneplate/scene/geometry/smooth_normals.h"
#include "zoneplate/signal/pattern/gradient_noise.h"

namespace zoneplate {
namespace mountain_scene {
namespace {

/// The height over the ground at (x, z) in [-1, 1]²: ridges of 1 - |noise|, each octave weighted by the one before, so
/// that valleys stay smooth, under a hump that falls to 0 at the border.
///
/// Source    Musgrave in Ebert et al., Texturing and Modeling, 3rd edition 2003, chapter 16 (ridged multifractal).
float height_at(float x, float z, int octaves) {
  using F = scalar::Float;
  float sum = 0, weight = 1, amplitude = 0.5f, frequency = 1.6f;
  for (int i = 0; i < octaves; ++i) {
    const float n = gradient_noise<F>({F(x * frequency + 3.7f), F(0.5f), F(z * frequency + 8.1f)}).value.v;
    const float ridge = (1 - std::abs(n)) * (1 - std::abs(n)) * weight;
    sum += ridge * amplitude;
    weight = std::clamp(ridge * 1.6f, 0.0f, 1.0f);
    amplitude *= 0.5f, frequency *= 2.1f;
  }
  const float distance = std::min(x * x + z * z, 1.0f), hump = (1 - distance) * (1 - distance);
  return hump * (0.10f + 0.55f * sum);
}

float4 color_at(float height, float3 normal) {
  constexpr float3 grass{0.09f, 0.13f, 0.035f}, rock{0.19f, 0.165f, 0.145f}, snow{0.86f, 0.89f, 0.94f};
  const auto ramp = [](float from, float to, float v) { return std::clamp((v - from) / (to - from), 0.0f, 1.0f); };
  float3 color = grass + (rock - grass) * std::max(ramp(0.12f, 0.22f, height), ramp(0.80f, 0.62f, normal.y));
  color = color + (snow - color) * (ramp(0.28f, 0.36f, height) * ramp(0.50f, 0.68f, normal.y));
  return {color.x, color.y, color.z, 1};
}

Mesh height_field(int cells, int octaves) {
  const auto columns = static_cast<std::size_t>(cells) + 1;
  const float step = 2 / static_cast<float>(cells);
  BenchMesh out(columns * columns, 6 * static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells));
  parallel_for(columns, [&](std::size_t row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const float x = static_cast<float>(column) * step - 1, z = 1 - static_cast<float>(row) * step;
      const std::size_t at = row * columns + column;
      out.mesh.position[at] = {x, height_at(x, z, octaves), z};
      out.mesh.uv0[at] = {0.5f * (x + 1), 0.5f * (z + 1)};
    }
  });
  Mesh mesh = std::move(out.mesh);
  fill_grid(mesh.index, 0, cells, cells);
  mesh.normal.clear();
  make_smooth_normals(mesh);
  mesh.color.resize(mesh.position.size());
  for (std::size_t v = 0; v < mesh.color.size(); ++v) mesh.color[v] = color_at(mesh.position[v].y, mesh.normal[v]);
  return mesh;
}

constexpr Param params[] = {{"size", "cells of the height field, per side", 256, 2, 4096},
                            {"octaves", "of noise", 9, 1, 12}};

Scene make(std::span<const std::int64_t> values) {
  Scene scene;
  Material ground;
  ground.name = "ground";
  ground.metallic = 0, ground.roughness = 0.9f;
  scene.materials.push_back(ground);
  add_object(scene, "mountain", height_field(static_cast<int>(values[0]), static_cast<int>(values[1])));
  scene.cameras.push_back(camera_at({1.5f, 1.0f, 2.5f}, {0, 0.16f, 0}, 0.56f, 0.1f, 10));
  return scene;
}

}  // namespace
}  // namespace mountain_scene

BuiltinMaker builtin_mountain() {
  return {"mountain", "a height field of ridged fractal noise", mountain_scene::params, mountain_scene::make};
}

}  // namespace zoneplate
