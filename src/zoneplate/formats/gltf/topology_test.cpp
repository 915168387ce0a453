// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/topology.h"

#include <gtest/gtest.h>

#include <vector>

namespace zoneplate {
namespace {

using List = std::vector<std::uint32_t>;
const List five{10, 11, 12, 13, 14};

TEST(GltfTopology, Kinds) {
  for (int mode = 0; mode <= 6; ++mode)
    EXPECT_EQ(gltf_topology(mode), mode == 0 ? Topology::Points : mode < 4 ? Topology::Lines : Topology::Triangles);
}

TEST(GltfTopology, ListsAsTheSpecificationNumbersThem) {
  EXPECT_EQ(list_primitives(five, 0), five);
  EXPECT_EQ(list_primitives(five, 1), (List{10, 11, 12, 13}));
  EXPECT_EQ(list_primitives(five, 2), (List{10, 11, 11, 12, 12, 13, 13, 14, 14, 10}));
  EXPECT_EQ(list_primitives(five, 3), (List{10, 11, 11, 12, 12, 13, 13, 14}));
  EXPECT_EQ(list_primitives(five, 4), (List{10, 11, 12}));
  EXPECT_EQ(list_primitives(five, 5), (List{10, 11, 12, 11, 13, 12, 12, 13, 14}));
  EXPECT_EQ(list_primitives(five, 6), (List{11, 12, 10, 12, 13, 10, 13, 14, 10}));
}

TEST(GltfTopology, TooFewVerticesDrawNothing) {
  for (int mode = 1; mode <= 6; ++mode) {
    EXPECT_TRUE(list_primitives({}, mode).empty());
    EXPECT_TRUE(list_primitives(List{7}, mode).empty()) << mode;
  }
  for (int mode = 4; mode <= 6; ++mode) EXPECT_TRUE(list_primitives(List{7, 8}, mode).empty()) << mode;
}

/// A zigzag strip is planar, so that all its triangles must have the same winding.
TEST(GltfTopology, StripKeepsItsWinding) {
  const List order{0, 1, 2, 3, 4, 5, 6};
  const List list = list_primitives(order, 5);
  const auto point = [](std::uint32_t i) { return float3{static_cast<float>(i / 2), i % 2 ? 0.0f : 1.0f, 0}; };
  for (std::size_t k = 0; k < list.size(); k += 3) {
    const float3 a = point(list[k]), b = point(list[k + 1]), c = point(list[k + 2]);
    EXPECT_GT(cross(b - a, c - a).z, 0) << k;
  }
}

}  // namespace
}  // namespace zoneplate
