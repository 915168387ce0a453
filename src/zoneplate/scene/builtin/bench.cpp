// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/builtin/bench.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

/// A pseudorandom value in [-1, 1) for each point of the integer lattice.
float lattice(int x, int y, int z) {
  const auto u = [](int i) { return static_cast<std::uint32_t>(i); };
  const std::uint32_t h = hash_word(u(x) * 73856093u ^ u(y) * 19349663u ^ u(z) * 83492791u);
  return static_cast<float>(h >> 8) * 0x1p-23f - 1;
}

float blend(float a, float b, float t) { return a + (b - a) * t; }

/// Lattice values interpolated by quintic steps.
float smooth_noise(float x, float y, float z) {
  const float fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy), iz = static_cast<int>(fz);
  const auto step = [](float t) { return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f); };
  const float tx = step(x - fx), ty = step(y - fy), tz = step(z - fz);
  const auto layer = [&](int k) {
    return blend(blend(lattice(ix, iy, k), lattice(ix + 1, iy, k), tx),
                 blend(lattice(ix, iy + 1, k), lattice(ix + 1, iy + 1, k), tx), ty);
  };
  return blend(layer(iz), layer(iz + 1), tz);
}

std::uint8_t to_code(int value) { return static_cast<std::uint8_t>(std::clamp(value, 0, 255)); }

Rgba8 brick_texel(int x, int y, int size) {
  const int row = y / 64, along = (x + (row & 1) * 64) % size, column = along / 128;
  const bool is_mortar = (y % 64) < 6 || (along % 128) < 6;
  const std::uint32_t of_brick = hash_word(static_cast<std::uint32_t>(row * 131 + column * 7 + 1));
  const std::uint32_t of_texel = hash_word(static_cast<std::uint32_t>(y * size + x));
  const int grain = static_cast<int>(of_texel & 31) - 16, tint = static_cast<int>(of_brick & 63) - 32;
  const int r = is_mortar ? 190 : 160 + tint, g = is_mortar ? 185 : 84 + tint / 2, b = is_mortar ? 175 : 62 + tint / 3;
  return {to_code(r + grain), to_code(g + grain), to_code(b + grain),
          static_cast<std::uint8_t>(96 + (of_texel >> 8) % 64)};
}

}  // namespace

float bumps(float x, float y, float z) {
  float sum = 0, height = 1, frequency = 3;
  for (int octave = 0; octave < 4; ++octave) {
    sum += height * smooth_noise(x * frequency, y * frequency, z * frequency);
    height *= 0.5f;
    frequency *= 2.1f;
  }
  return sum;
}

TextureImage brick_texture() {
  constexpr int size = 1024;
  Rgba8Image image(size, size);
  parallel_for(size, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size; ++x) image(x, y) = brick_texel(x, y, size);
  });
  return {"bricks", std::move(image)};
}

BenchMesh::BenchMesh(std::size_t vertices, std::size_t indices) {
  make_large(mesh.position, vertices);
  make_large(mesh.normal, vertices);
  make_large(mesh.uv0, vertices);
  make_large(mesh.index, indices);
}

void BenchMesh::add_quad(const float3 (&corner)[4], float3 normal, const float2 (&uv)[4]) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (std::size_t k = 0; k < 4; ++k) {
    mesh.position.push_back(corner[k]);
    mesh.normal.push_back(normal);
    mesh.uv0.push_back(uv[k]);
  }
  for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.index.push_back(first + k);
}

void fill_grid(std::span<std::uint32_t> index, std::uint32_t first, int nx, int ny) {
  const auto columns = static_cast<std::size_t>(nx);
  parallel_ranges(static_cast<std::size_t>(ny), 16, [&](std::size_t begin, std::size_t end) {
    std::uint32_t* out = index.data() + begin * columns * 6;
    for (std::size_t j = begin; j < end; ++j)
      for (std::size_t i = 0; i < columns; ++i) {
        const std::uint32_t q = first + static_cast<std::uint32_t>(j * (columns + 1) + i);
        const std::uint32_t r = q + static_cast<std::uint32_t>(columns + 1);
        for (const std::uint32_t v : {q, q + 1, r + 1, q, r + 1, r}) *out++ = v;
      }
  });
}

Scene lit_scene(const char* name, Mesh mesh, const BenchLook& look) {
  Scene scene;
  Material material;
  material.name = name;
  material.model = ShadingModel::BlinnPhong;
  material.double_sided = look.double_sided;
  material.base_color = {look.base.x, look.base.y, look.base.z, 1};
  material.ambient = look.base;
  material.specular = {look.specular, look.specular, look.specular};
  material.exponent = look.exponent;
  if (look.textured) {
    scene.images.push_back(brick_texture());
    material.base_color_texture.image = 0;
    material.base_color_texture.sampler.anisotropy = look.anisotropy;
  }
  scene.materials.push_back(std::move(material));
  add_object(scene, name, std::move(mesh));
  scene.ambient_light = {look.ambient, look.ambient, look.ambient};
  Light light;
  light.name = "light";
  light.direction = -look.light;
  scene.lights.push_back(std::move(light));
  return scene;
}

}  // namespace zoneplate
