// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/smooth_normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

/// A wavy sheet of size × size cells, with triangles and vertices in a scattered order.
Mesh scattered_sheet(std::uint32_t size) {
  Mesh mesh;
  // A prime, so that every index occurs.
  const std::uint32_t across = size + 1, vertices = across * across, step = 7919;
  const auto place = [&](std::uint32_t v) { return static_cast<std::uint32_t>(std::uint64_t{v} * step % vertices); };
  mesh.position.resize(vertices);
  for (std::uint32_t j = 0; j < across; ++j)
    for (std::uint32_t i = 0; i < across; ++i) {
      const float x = static_cast<float>(i) * 0.1f, z = static_cast<float>(j) * 0.1f;
      mesh.position[place(j * across + i)] = {x, 0.2f * unit_float(hash(i, j)) + std::sqrt(x + z), z};
    }
  for (std::uint32_t k = 0; k < size * size; ++k) {
    const std::uint32_t cell = hash(k) % (size * size), i = cell % size, j = cell / size;
    const std::uint32_t a = j * across + i, b = a + 1, c = a + across, d = c + 1;
    for (const std::uint32_t v : {a, c, b, b, c, d}) mesh.index.push_back(place(v));
  }
  return mesh;
}

TEST(SmoothNormals, AreTheSameBitsForAnyNumberOfThreads) {
  const Mesh sheet = scattered_sheet(200);
  Mesh expected = sheet;
  with_threads(1, [&] { make_smooth_normals(expected); });
  for (const int threads : {2, 3, 7}) {
    Mesh mesh = sheet;
    with_threads(threads, [&] { make_smooth_normals(mesh); });
    EXPECT_EQ(mesh.normal, expected.normal) << threads;
    EXPECT_EQ(mesh.index, expected.index) << threads;
    EXPECT_EQ(mesh.position, expected.position) << threads;
  }
}

TEST(SmoothNormals, OfFewVerticesNeedNoThreads) {
  Mesh mesh;
  mesh.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.index = {0, 1, 2};
  with_threads(8, [&] { make_smooth_normals(mesh); });
  EXPECT_EQ(mesh.normal, std::vector<float3>(3, {0, 0, 1}));
}

}  // namespace
}  // namespace zoneplate
