// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/displace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Place = std::tuple<float, float, float>;
Place place(float3 p) { return {p.x, p.y, p.z}; }

/// A cube of six separate sides, each with the whole map: its edges are seams of normals and texture coordinates.
Mesh cube() {
  constexpr float3 normals[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  Mesh mesh;
  for (const float3 n : normals) {
    const float3 u = std::abs(n.x) > 0 ? float3{0, 1, 0} : float3{1, 0, 0}, v = cross(n, u);
    const auto first = static_cast<std::uint32_t>(mesh.position.size());
    for (const float2 at : {float2{0, 0}, float2{1, 0}, float2{1, 1}, float2{0, 1}}) {
      mesh.position.push_back(n + u * (2 * at.x - 1) + v * (2 * at.y - 1));
      mesh.normal.push_back(n);
      mesh.uv0.push_back(at);
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.index.push_back(first + i);
  }
  return mesh;
}

/// Whether every edge joins two triangles that run along it in opposite directions.
bool is_closed(const Mesh& mesh) {
  std::map<std::pair<Place, Place>, int> count;
  for (std::size_t i = 0; i < mesh.index.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Place a = place(mesh.position[mesh.index[i + k]]), b = place(mesh.position[mesh.index[i + (k + 1) % 3]]);
      if (a < b)
        ++count[{a, b}];
      else
        --count[{b, a}];
    }
  for (const auto& [edge, balance] : count)
    if (balance != 0) return false;
  return true;
}

/// Bilinear interpolation of n × n random heights.
HeightMap random_heights(int n) {
  const auto height = [n](float2 uv) {
    const float x = std::clamp(uv.x, 0.0f, 0.999f) * static_cast<float>(n),
                y = std::clamp(uv.y, 0.0f, 0.999f) * static_cast<float>(n);
    const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
    const float s = x - static_cast<float>(column), t = y - static_cast<float>(row);
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return 0.2f * unit_float(hash(column + i, row + j)); };
    return (at(0, 0) * (1 - s) + at(1, 0) * s) * (1 - t) + (at(0, 1) * (1 - s) + at(1, 1) * s) * t;
  };
  return {height, {static_cast<float>(n), static_cast<float>(n)}};
}

TEST(Displace, AClosedMeshStaysClosed) {
  const Displaced out = displace(cube(), random_heights(8), {.tolerance = 0.01f});
  EXPECT_TRUE(out.is_complete);
  EXPECT_GT(out.mesh.index.size() / 3, 500u);
  EXPECT_TRUE(is_closed(out.mesh));
  for (const float3 n : out.mesh.normal) EXPECT_NEAR(dot(n, n), 1, 1e-5f);
}

TEST(Displace, RefinesOnlyWhereTheHeightChanges) {
  // A ramp in one corner of an otherwise flat square: an exact number of triangles is not fixed, but few lie elsewhere.
  Mesh square;
  square.position = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.normal.assign(4, {0, 0, 1});
  square.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  square.index = {0, 1, 2, 0, 2, 3};
  const HeightMap map{[](float2 uv) { return std::max(0.0f, 0.1f - (uv.x * uv.x + uv.y * uv.y)); }, {256, 256}};
  const Displaced out = displace(square, map, {.tolerance = 2e-5f});
  std::size_t inside = 0, outside = 0;
  for (std::size_t i = 0; i < out.mesh.index.size(); i += 3) {
    float3 centre{};
    for (std::size_t k = 0; k < 3; ++k) centre = centre + out.mesh.position[out.mesh.index[i + k]] * (1.0f / 3);
    ++(centre.x * centre.x + centre.y * centre.y < 0.16f ? inside : outside);
  }
  EXPECT_GT(inside, 8 * outside);
  for (std::size_t v = 0; v < out.mesh.position.size(); ++v)
    EXPECT_FLOAT_EQ(out.mesh.position[v].z, map.height(out.mesh.uv0[v]));
}

TEST(Displace, AFlatMapChangesNothing) {
  const Mesh mesh = cube();
  const Displaced out = displace(mesh, {[](float2) { return 0.0f; }, {8, 8}}, {});
  EXPECT_EQ(out.mesh.position, mesh.position);
  EXPECT_EQ(out.mesh.index, mesh.index);
  EXPECT_EQ(out.mesh.normal, mesh.normal);
}

TEST(Displace, StopsAtTheGreatestNumberOfTriangles) {
  const Displaced out = displace(cube(), random_heights(256), {.tolerance = 0, .max_triangles = 5000});
  EXPECT_FALSE(out.is_complete);
  EXPECT_LE(out.mesh.index.size() / 3, 5000u);
  EXPECT_TRUE(is_closed(out.mesh));
}

}  // namespace
}  // namespace zoneplate
