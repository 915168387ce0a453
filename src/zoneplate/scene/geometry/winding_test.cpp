// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/winding.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

/// Two triangles in the plane z = 0, counter-clockwise seen from +z.
Mesh tilted_square(float3 normal) {
  Mesh m;
  m.position = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  m.normal.assign(4, normal);
  m.index = {0, 1, 2, 0, 2, 3};
  return m;
}

TEST(Winding, FollowsTheNormalsOfMostTriangles) {
  Mesh m = tilted_square({0, 0, 1});
  turn_to_normals(m);
  EXPECT_EQ(m.index, tilted_square(float3{}).index);
  m = tilted_square({0, 0, -1});
  turn_to_normals(m);
  EXPECT_EQ(m.index, (std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2}));
}

TEST(Winding, StaysWhereNormalsDoNotDecide) {
  Mesh m = tilted_square({1, 0, 0});
  turn_to_normals(m);
  EXPECT_EQ(m.index, tilted_square(float3{}).index);
  m = tilted_square({0, 0, -1});
  m.normal.clear();
  turn_to_normals(m);
  EXPECT_EQ(m.index, tilted_square(float3{}).index);
  m = tilted_square({0, 0, -1});
  m.topology = Topology::Lines;
  turn_to_normals(m);
  EXPECT_EQ(m.index, tilted_square(float3{}).index);
}

}  // namespace
}  // namespace zoneplate
