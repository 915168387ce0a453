// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/mesh_edges.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/scene/geometry/solids_for_test.h"

namespace zoneplate {
namespace {

TEST(MeshEdges, SeamsOfABoxAreEdgesOfTwoTriangles) {
  const std::vector<MeshEdge> edges = mesh_edges(box_mesh({{0, 0, 0}, {1, 2, 3}}));
  EXPECT_EQ(edges.size(), 18u);  // twelve of the box and six diagonals
  for (const MeshEdge& edge : edges) {
    EXPECT_NE(edge.face[1], MeshEdge::no_face);
    EXPECT_TRUE(edge.is_manifold);
    EXPECT_FALSE(edge.is_turned);
  }
}

TEST(MeshEdges, BoundariesTurnedAndSharedTriangles) {
  Mesh mesh;
  mesh.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}};
  mesh.index = {0, 1, 2};
  std::vector<MeshEdge> edges = mesh_edges(mesh);
  ASSERT_EQ(edges.size(), 3u);
  for (const MeshEdge& edge : edges) EXPECT_EQ(edge.face[1], MeshEdge::no_face);

  mesh.index = {0, 1, 2, 1, 2, 3};  // both have the edge from 1 to 2
  edges = mesh_edges(mesh);
  ASSERT_EQ(edges.size(), 5u);
  EXPECT_EQ(std::ranges::count_if(edges, &MeshEdge::is_turned), 1);

  mesh.index = {0, 1, 2, 1, 3, 2, 2, 1, 4};  // three have it
  edges = mesh_edges(mesh);
  EXPECT_EQ(std::ranges::count_if(edges, [](const MeshEdge& e) { return !e.is_manifold; }), 2);
}

TEST(MeshEdges, TrianglesWithEqualCornersHaveNone) {
  Mesh mesh;
  mesh.position = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}};
  mesh.index = {0, 1, 2};
  EXPECT_TRUE(mesh_edges(mesh).empty());
}

}  // namespace
}  // namespace zoneplate
