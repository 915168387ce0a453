// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/flat_normals.h"

#include <array>
#include <cmath>
#include <cstring>

namespace zoneplate {
float3 flat_normal(float3 a, float3 b, float3 c) {
  const double ux = double{b.x} - a.x, uy = double{b.y} - a.y, uz = double{b.z} - a.z;
  const double vx = double{c.x} - a.x, vy = double{c.y} - a.y, vz = double{c.z} - a.z;
  const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
  const double square = x * x + y * y + z * z;
  if (!(square > 0 && square < 1e300)) return {0, 1, 0};
  const double scale = 1 / std::sqrt(square);
  return {static_cast<float>(x * scale), static_cast<float>(y * scale), static_cast<float>(z * scale)};
}

namespace scalar {
namespace {

void make(const std::uint8_t* corners, std::size_t stride, std::size_t triangles, float* normal) {
  for (std::size_t i = 0; i < triangles; ++i) {
    std::array<float3, 3> p;
    std::memcpy(p.data(), corners + i * stride, sizeof p);
    const float3 n = flat_normal(p[0], p[1], p[2]);
    for (std::size_t k = 0; k < 9; k += 3)
      normal[9 * i + k] = n.x, normal[9 * i + k + 1] = n.y, normal[9 * i + k + 2] = n.z;
  }
}

}  // namespace

}  // namespace scalar

template <>
const FlatNormalKernels PerIsa<FlatNormalKernels>::scalar = {.make = scalar::make};

}  // namespace zoneplate
