// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "zoneplate/math/random.h"
#include "zoneplate/ray/bvh.h"
#include "zoneplate/ray/trace.h"

namespace zoneplate {

/// Triangles for tests of rays.
struct TestMesh {
  std::vector<float3> position;
  std::vector<std::uint32_t> index;
  ShadowCaster caster() const { return {position, index, {}, false}; }
};

/// Four pseudo-random numbers in [0, 1).
inline float4 random_numbers(std::uint32_t a, std::uint32_t b) {
  return {unit_float(hash(a, b, 0)), unit_float(hash(a, b, 1)), unit_float(hash(a, b, 2)), unit_float(hash(a, b, 3))};
}

/// A closed, bumpy sphere of 2 × n × n triangles around the origin, of radius 1.
inline TestMesh bumpy_sphere(std::uint32_t n) {
  TestMesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const double theta = 3.14159265358979 * y / n, phi = 6.28318530717959 * x / n;
      const double r = y == 0 || y == n ? 1 : 1 + 0.1 * std::sin(9 * theta) * std::sin(7 * phi);
      mesh.position.push_back({static_cast<float>(r * std::sin(theta) * std::cos(phi)),
                               static_cast<float>(r * std::cos(theta)),
                               static_cast<float>(r * std::sin(theta) * std::sin(phi))});
    }
  // All vertices of a pole are the first one there.
  const auto at = [&](std::uint32_t x, std::uint32_t y) { return y * n + (y == 0 || y == n ? 0 : x % n); };
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x)
      for (const std::uint32_t v : {at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)})
        mesh.index.push_back(v);
  return mesh;
}

/// Triangles of side `size` anywhere in the unit cube.
inline TestMesh triangle_soup(std::uint32_t count, float size) {
  TestMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float4 p = random_numbers(i, 1);
    for (std::uint32_t k = 0; k < 3; ++k) {
      const float4 d = random_numbers(i, 2 + k);
      mesh.position.push_back(float3{p.x, p.y, p.z} + float3{d.x - 0.5f, d.y - 0.5f, d.z - 0.5f} * size);
      mesh.index.push_back(3 * i + k);
    }
  }
  return mesh;
}

/// A ray from a point of the cube [-2, 2]³ to one of the ball of radius 1.
inline Ray random_ray(std::uint32_t i) {
  const float4 from = random_numbers(i, 11), to = random_numbers(i, 12);
  const float3 o{4 * from.x - 2, 4 * from.y - 2, 4 * from.z - 2};
  const float3 d = float3{2 * to.x - 1, 2 * to.y - 1, 2 * to.z - 1} - o;
  return {{o.x, o.y, o.z}, {d.x, d.y, d.z}};
}

}  // namespace zoneplate
