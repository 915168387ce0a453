// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/visibility.h"

#include <gtest/gtest.h>

#include "zoneplate/raster/tile/tile_for_test.h"

namespace zoneplate {
namespace {

TEST(VisibilityStage, TheNearestTriangleOwnsEachSample) {
  // Triangle 1 is nearer and covers the lower left half; a tiny triangle, drawn through sample bins, lies in front.
  std::vector<TestTriangle> triangles = {full_tile(0.2f, {}), full_tile(0.6f, {})};
  triangles[1].clip = {{{-1, -1, 0.6f, 1}, {1, -1, 0.6f, 1}, {-1, 1, 0.6f, 1}}};
  const float pixel = 2.0f / tile_size;
  triangles.push_back({{{{0, 0, 0.9f, 1}, {2 * pixel, 0, 0.9f, 1}, {0, 2 * pixel, 0.9f, 1}}}, {}});
  const TileScene scene(triangles, standard_pattern(1));
  TileBuffers b(*scene.setup);
  begin_whole_pass(b);
  rasterize_opaque(b.job, b.visibility);
  b.visibility.materialize_all();
  const auto at = [&](int x, int y) { return b.visibility.id[y * tile_size + x]; };
  EXPECT_EQ(at(63, 0), 0);
  EXPECT_EQ(at(0, 63), 1);
  EXPECT_EQ(at(32, 31), 2);  // above the image's centre
  EXPECT_EQ(at(34, 31), 0);
}

TEST(VisibilityStage, WritesOwnersAndDepthsWithoutShading) {
  std::vector<Plane<std::uint32_t>> ids(4, Plane<std::uint32_t>(tile_size, tile_size));
  std::vector<Plane<float>> depths(4, Plane<float>(tile_size, tile_size));
  Target target;
  target.sample_triangle = &ids;
  target.sample_depth = &depths;
  const TileScene scene({full_tile(0.25f, {})}, standard_pattern(4), {}, target);
  TileBuffers b(*scene.setup);
  begin_with_visibility(b, [](int s, int x, int) { return s == 2 && x < 10 ? 0 : no_primitive; });
  write_visibility(b.job, b.visibility);
  EXPECT_EQ(ids[2](9, 40), 0u);
  EXPECT_EQ(ids[2](10, 40), Target::no_id);
  EXPECT_EQ(ids[1](9, 40), Target::no_id);
  EXPECT_EQ(depths[2](9, 40), 0.5f);
  EXPECT_EQ(b.batcher.shaded(), 0u);
}

TEST(VisibilityStage, KeepsTheNearerTriangleOfSeveralCalls) {
  std::vector<Plane<std::uint32_t>> ids(1, Plane<std::uint32_t>(tile_size, tile_size, Target::no_id));
  std::vector<Plane<float>> depths(1, Plane<float>(tile_size, tile_size, 0.0f));
  Target target;
  target.sample_triangle = &ids;
  target.sample_depth = &depths;
  target.keeps_nearer = true;
  ids[0](1, 0) = 7, depths[0](1, 0) = 0.75f;
  ids[0](2, 0) = 8, depths[0](2, 0) = 0.5f;  // as near: the first one stays
  ids[0](3, 0) = 9, depths[0](3, 0) = 0.25f;
  const TileScene scene({full_tile(0.25f, {})}, standard_pattern(1), {}, target);
  TileBuffers b(*scene.setup);
  begin_with_visibility(b, [](int, int x, int) { return x < 4 ? 0 : no_primitive; });
  write_visibility(b.job, b.visibility);
  const auto row = ids[0].row(0);
  EXPECT_EQ(std::vector<std::uint32_t>(row.begin(), row.begin() + 5),
            (std::vector<std::uint32_t>{0, 7, 8, 0, Target::no_id}));
  EXPECT_EQ(depths[0](1, 0), 0.75f);
  EXPECT_EQ(depths[0](3, 0), 0.5f);
}

}  // namespace
}  // namespace zoneplate
