// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/parts/partition.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

namespace zoneplate {
namespace {

class DrawPartition : public ::testing::TestWithParam<Partition> {};

TEST_P(DrawPartition, GivesEachTriangleToOneRankWithTheIdOfTheWhole) {
  std::vector<std::uint32_t> index(3 * 1000);
  for (std::uint32_t i = 0; i < index.size(); ++i) index[i] = i;
  const std::vector<float3> position(index.size());
  const QuadMesh quads;
  std::vector<Draw> draws(4);
  const std::size_t sizes[] = {1000, 3, 400, 0};
  for (std::size_t d = 0; d < draws.size(); ++d) {
    draws[d].position = position;
    draws[d].index = std::span(index).first(3 * sizes[d]);
    draws[d].instance = static_cast<std::uint32_t>(d);
  }
  draws[2].quads = &quads;
  for (const int ranks : {1, 2, 3, 5, 8}) {
    const std::vector<TriangleRun> runs = runs_of(draws, GetParam(), ranks);
    std::map<std::int64_t, std::pair<std::uint32_t, std::uint32_t>> owned;  // by id: instance and primitive
    for (int rank = 0; rank < ranks; ++rank) {
      std::int64_t id = 0;
      for (const Draw& part : draws_of_rank(draws, runs, rank)) {
        EXPECT_TRUE(part.index.empty() || part.elsewhere == 0);
        for (std::uint32_t t = 0; part.elsewhere == 0 && t < part.triangles(); ++t) {
          EXPECT_TRUE(owned.emplace(id + t, std::pair(part.instance, part.primitive_of(t))).second);
          if (!part.quads) {
            EXPECT_EQ(part.index[3 * t], 3 * part.primitive_of(t));
          }
        }
        id += static_cast<std::int64_t>(part.triangles());
      }
      EXPECT_EQ(id, 1403);
    }
    ASSERT_EQ(owned.size(), 1403u);
    EXPECT_EQ(owned[0], std::pair(0u, 0u));
    EXPECT_EQ(owned[999], std::pair(0u, 999u));
    EXPECT_EQ(owned[1002], std::pair(1u, 2u));
    EXPECT_EQ(owned[1402], std::pair(2u, 199u));
  }
}

TEST_P(DrawPartition, LeavesEveryRankOfAFewSomeOfManyTriangles) {
  const std::vector<std::uint32_t> index(3 * 3000);
  std::vector<Draw> draws(30);
  for (Draw& draw : draws) draw.index = std::span(index).first(3 * 100);
  for (int rank = 0; rank < 3; ++rank) {
    std::size_t own = 0;
    for (const Draw& part : draws_of_rank(draws, runs_of(draws, GetParam(), 3), rank)) own += part.index.size() / 3;
    EXPECT_GT(own, 700u);
    EXPECT_LT(own, 1300u);
  }
}

INSTANTIATE_TEST_SUITE_P(All, DrawPartition,
                         ::testing::Values(Partition::Node, Partition::Index, Partition::Interleaved));

}  // namespace
}  // namespace zoneplate
