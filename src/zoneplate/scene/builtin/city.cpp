// SPDX-License-Identifier: Apache-2.0
// 80 × 50 textured boxes in a grid and the ground between them, viewed from the end of a street.
//
// The boxes are in random order, with the ground in the middle, so that they are not sorted for the renderer.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "zoneplate/scene/builtin/bench.h"

namespace zoneplate {
namespace city_scene {
namespace {

/// A sequence of random words for the layout of the city.
struct Sequence {
  std::uint32_t state;
  std::uint32_t word() { return hash_word(state += 0x9e3779b9u); }
  float unit() { return static_cast<float>(word() >> 8) * 0x1p-24f; }
};

struct House {
  float3 centre, half;
};

/// A side of a house: its two axes and its normal, their cross product.
struct Side {
  float3 u, v, normal;
};
constexpr Side sides[6] = {{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}},
                           {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                           {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
constexpr float repeats = 1.0f / 6;  // the texture repeats every 6 m

std::vector<House> houses() {
  constexpr int columns = 80, rows = 50;
  constexpr float pitch = 10;
  Sequence random{12345};
  std::vector<House> list;
  for (int z = 0; z < rows; ++z)
    for (int x = 0; x < columns; ++x) {
      const float width = 2.4f + 1.2f * random.unit();
      const float depth = 2.4f + 1.2f * random.unit();
      const float q = random.unit();
      const float height = 2.0f + 12.0f * q * q + 2.0f * random.unit();
      list.push_back({{(static_cast<float>(x) + 0.5f) * pitch, height, -(static_cast<float>(z) + 0.5f) * pitch},
                      {width, height, depth}});
    }
  for (std::size_t i = list.size() - 1; i > 0; --i)
    std::swap(list[i], list[random.word() % static_cast<std::uint32_t>(i + 1)]);
  return list;
}

/// The corners of a quad in its own coordinates: lower left, lower right, upper right, upper left.
constexpr float2 quad[4] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

void add_face(BenchMesh& out, const float3 (&corner)[4], float3 normal, float width, float height) {
  const float2 uv[4] = {{0, 0}, {width, 0}, {width, height}, {0, height}};
  out.add_quad(corner, normal, uv);
}

float sum_of_sizes(float3 axis, float3 half) {
  return std::abs(axis.x) * 2 * half.x + std::abs(axis.y) * 2 * half.y + std::abs(axis.z) * 2 * half.z;
}

void add_house(BenchMesh& out, const House& house) {
  for (const Side& side : sides) {
    float3 corner[4];
    for (std::size_t k = 0; k < 4; ++k)
      corner[k] = house.centre + house.half * ((side.normal + quad[k].x * side.u) + quad[k].y * side.v);
    add_face(out, corner, side.normal, sum_of_sizes(side.u, house.half) * repeats,
             sum_of_sizes(side.v, house.half) * repeats);
  }
}

Scene make(const char* name, int anisotropy) {
  BenchMesh out;
  const std::vector<House> list = houses();
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i == list.size() / 2) {
      constexpr float size = 1000;
      add_face(out, {{-100, 0, 100}, {size - 100, 0, 100}, {size - 100, 0, 100 - size}, {-100, 0, 100 - size}},
               {0, 1, 0}, size * repeats, size * repeats);
    }
    add_house(out, list[i]);
  }
  Scene scene = lit_scene(name, std::move(out.mesh),
                          {.base = {1, 1, 1}, .specular = 0.25f, .textured = true, .anisotropy = anisotropy});
  scene.cameras.push_back(camera_at({200, 1.7f, 4}, {206.5f, 2.9f, -16}, 1.0471976f, 0.2f, 1200));
  return scene;
}

}  // namespace
}  // namespace city_scene

BuiltinMaker builtin_city() {
  return {"city", "4,000 textured boxes and the ground, from a street; 8x anisotropic filter", {}, [](auto) {
            return city_scene::make("city", 8);
          }};
}
BuiltinMaker builtin_city_trilinear() {
  return {"city-trilinear", "benchmark: the city without anisotropic filtering", {}, [](auto) {
            return city_scene::make("city-trilinear", 1);
          }};
}

}  // namespace zoneplate
