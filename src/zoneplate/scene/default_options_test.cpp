// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/default_options.h"

#include <gtest/gtest.h>

#include <numeric>

#include "zoneplate/scene/scene.h"

namespace zoneplate {
namespace {

Scene cloud(std::uint32_t points, std::size_t instances) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.topology = Topology::Points;
  mesh.index.resize(points);
  std::iota(mesh.index.begin(), mesh.index.end(), 0u);
  scene.instances.resize(instances);
  return scene;
}

TEST(UsualPointSize, CoversASixteenthOfTheImage) {
  EXPECT_FLOAT_EQ(default_point_size(cloud(4096, 1), 1024, 1024), 4);
  EXPECT_FLOAT_EQ(default_point_size(cloud(1024, 4), 1024, 1024), 4);
  EXPECT_FLOAT_EQ(default_point_size(cloud(4096, 1), 2048, 2048), 8);
}

TEST(UsualPointSize, IsAtLeastAPixelAndAtMostAHundredthOfTheHeight) {
  EXPECT_EQ(default_point_size(cloud(1 << 20, 1), 512, 512), 1);
  EXPECT_FLOAT_EQ(default_point_size(cloud(4, 1), 800, 600), 6);
  EXPECT_EQ(default_point_size(cloud(4, 1), 64, 32), 1);
  EXPECT_FLOAT_EQ(default_point_size({}, 800, 600), 6);
}

TEST(UsualPointSize, TrianglesAndLinesAreNoPoints) {
  Scene scene = cloud(4096, 1);
  scene.meshes.emplace_back().index.resize(3 << 20);
  scene.instances.push_back({1, 0, {}});
  EXPECT_FLOAT_EQ(default_point_size(scene, 1024, 1024), 4);
}

}  // namespace
}  // namespace zoneplate
