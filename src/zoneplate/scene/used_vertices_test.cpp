// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/used_vertices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/points_for_test.h"

namespace zoneplate {
namespace {

/// 100,000 vertices, of which primitives use those with odd indices.
Scene many() {
  Scene scene = point_scene(100000, {0, 0, 7}, [](float a, float b, float c) { return float3{a, b, c}; });
  Mesh& mesh = scene.meshes[0];
  for (std::uint32_t i = 1; i < 100000; i += 2) mesh.index.insert(mesh.index.end(), {i, i});
  mesh.position[40000] = {50, 0, 0};
  mesh.position[40001] = {0, 60, 0};
  return scene;
}

TEST(UsedVertices, AreThoseOfPrimitives) {
  const Scene scene = many();
  for (const int threads : {1, 3})
    with_threads(threads, [&] {
      UsedVertices used(scene);
      const std::span<const std::uint8_t> flags = used.of(0);
      ASSERT_EQ(flags.size(), 100000u);
      for (std::size_t i = 0; i < flags.size(); ++i) ASSERT_EQ(flags[i], i % 2) << i;
      const Box box = used.bounds();
      EXPECT_EQ(box.high.y, 60);
      EXPECT_LT(box.high.x, 1);
      EXPECT_GT(box.high.z, 7);
    });
}

/// Instances of a mesh of 300 vertices at very many positions, some of them equal.
Scene forest(std::uint32_t trees) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.topology = Topology::Points;
  for (std::uint32_t i = 0; i < 300; ++i) {
    mesh.position.push_back({unit_float(hash(i, 1)) - 0.5f, unit_float(hash(i, 2)) - 0.5f, unit_float(hash(i, 3))});
    if (i % 3 != 0) mesh.index.push_back(i);
  }
  scene.materials.emplace_back();
  for (std::uint32_t i = 0; i < trees; ++i) {
    const float3 place{100 * unit_float(hash(i, 4)), unit_float(hash(i, 5)), 100 * unit_float(hash(i, 6))};
    const float angle = 6 * unit_float(hash(i, 7));
    const Quaternion turn{0, std::sqrt(angle / 6), 0, std::sqrt(1 - angle / 6)};
    scene.instances.push_back({0, 0, translation(place) * rotation(turn)});
  }
  return scene;
}

TEST(UsedVertices, PlacementsThatCannotReachFarthestAreLeftOut) {
  const Scene scene = forest(5000);
  std::vector<float3> axes;
  for (std::uint32_t i = 0; i < 22; ++i)
    axes.push_back({unit_float(hash(i, 8)) - 0.5f, unit_float(hash(i, 9)) - 0.5f, unit_float(hash(i, 10)) - 0.5f});
  UsedVertices used(scene);
  const std::vector<std::size_t> some = used.reaching(axes);
  EXPECT_LT(some.size(), 200u);
  for (const float3 axis : axes) {
    // The first instance that has a vertex with the greatest extent.
    float most = -1e9f;
    std::size_t first = 0;
    for (std::size_t i = 0; i < scene.instances.size(); ++i)
      for (const std::uint32_t v : scene.meshes[0].index)
        if (const float x =
                dot(axis, transform_point(scene.instances[i].world_from_object, scene.meshes[0].position[v]));
            x > most)
          most = x, first = i;
    EXPECT_TRUE(std::binary_search(some.begin(), some.end(), first));
  }
  Box box;
  for (const Instance& i : scene.instances)
    for (const std::uint32_t v : scene.meshes[0].index)
      box.add(transform_point(i.world_from_object, scene.meshes[0].position[v]));
  EXPECT_EQ(used.bounds().low, box.low);
  EXPECT_EQ(used.bounds().high, box.high);
}

TEST(UsedVertices, OfPlacementsThatAreTheSameOneIsLookedAt) {
  Scene scene = forest(1);
  scene.instances.resize(1000, scene.instances[0]);
  EXPECT_EQ(UsedVertices(scene).reaching(std::array{float3{1, 0, 0}}), std::vector<std::size_t>{0});
  EXPECT_TRUE(UsedVertices(Scene{}).reaching(std::array{float3{1, 0, 0}}).empty());
}

}  // namespace
}  // namespace zoneplate
