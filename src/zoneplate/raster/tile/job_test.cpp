// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/job.h"

#include <gtest/gtest.h>

#include "zoneplate/raster/tile/tile_for_test.h"

namespace zoneplate {
namespace {

TEST(TileJob, WeightsOfSetsAreTabulatedExactly) {
  Target target;
  target.weights = {0.1f, 0.7f, 1.3f, 0.05f};
  const TileScene scene({full_tile(0.5f, {})}, standard_pattern(4), {}, target);
  for (std::uint32_t set = 0; set < 16; ++set)
    EXPECT_EQ(scene.setup->tabulated_weights()[set], scene.setup->weight_of(set, 0));
  EXPECT_EQ(scene.setup->weight_of(1, 2), 1.3f);
}

TEST(TileJob, OpaqueTrianglesComeRoughlyNearestFirst) {
  std::vector<TestTriangle> triangles;
  for (const float depth : {0.1f, 0.9f, 0.4f, 0.7f}) triangles.push_back(full_tile(depth, {}));
  const TileScene scene(triangles, standard_pattern(1));
  TileBuffers b(*scene.setup);
  begin_whole_pass(b);
  std::vector<std::int32_t> ids;
  for (const Triangle* t : b.job.triangles_of(AlphaMode::Opaque)) ids.push_back(t->id);
  EXPECT_EQ(ids, (std::vector<std::int32_t>{1, 3, 2, 0}));
}

TEST(TileJob, AFragmentOfAllSamplesIsAtTheCentre) {
  const TileScene scene({full_tile(0.5f, {})}, standard_pattern(4));
  TileBuffers b(*scene.setup);
  begin_whole_pass(b);
  const Fragment whole = b.job.fragment_at(64 * 2 + 7, 0, b.job.pass.all);
  EXPECT_EQ(whole.x, 7 * 256 + 128);
  EXPECT_EQ(whole.y, 2 * 256 + 128);
  std::vector<Fragment> each;
  b.job.add_fragments(64 * 2 + 7, 0, 0b1010, true, each);
  ASSERT_EQ(each.size(), 2u);
  EXPECT_EQ(each[1].samples, 8u);
  EXPECT_EQ(each[1].x, 7 * 256 + standard_pattern(4)[3].x);
}

}  // namespace
}  // namespace zoneplate
