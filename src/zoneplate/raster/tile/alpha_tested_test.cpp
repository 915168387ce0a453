// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/alpha_tested.h"

#include <gtest/gtest.h>

#include <bit>

#include "zoneplate/raster/tile/tile_for_test.h"

namespace zoneplate {
namespace {

/// Draws the alpha-tested triangles into an empty tile.
void test_alpha_alone(TileBuffers& b) {
  begin_with_visibility(b, [](int, int, int) { return no_primitive; });
  b.alpha_tester.rasterize(b.job, b.batcher, b.visibility);
}

TEST(AlphaTestStage, ASurfaceIsPresentWhereAlphaReachesTheCutoff) {
  const TileScene scene({full_tile(0.2f, {1, 1, 1, 1}), full_tile(0.4f, {1, 1, 1, 0.6f}, AlphaMode::Mask),
                         full_tile(0.6f, {1, 1, 1, 0.4f}, AlphaMode::Mask)},
                        standard_pattern(4));
  TileBuffers b(*scene.setup);
  test_alpha_alone(b);
  for (std::uint32_t i = 0; i < 4 * tile_pixels; ++i) {
    ASSERT_EQ(b.visibility.id[sample_place(i)], 1);
    ASSERT_EQ(b.visibility.depth[sample_place(i)], 0.4f);
  }
}

TEST(AlphaTestStage, CoverageTakesAsManySamplesAsAlphaGives) {
  Target target;
  target.alpha = AlphaTest::Coverage;
  const TileScene scene({full_tile(0.4f, {1, 1, 1, 0.25f}, AlphaMode::Mask)}, standard_pattern(8), {}, target);
  TileBuffers b(*scene.setup);
  test_alpha_alone(b);
  for (int pixel = 0; pixel < tile_pixels; ++pixel) {
    int samples = 0;
    for (int s = 0; s < 8; ++s) samples += b.visibility.id[s * sample_stride + pixel] == 0;
    ASSERT_EQ(samples, 2);
  }
}

TEST(AlphaTestStage, PartsGiveTheSameVisibilityAsTheWhole) {
  std::vector<TestTriangle> triangles = random_triangles(5, 40, AlphaMode::Mask);
  std::vector<std::int32_t> whole;
  for (const std::size_t room : {std::size_t{1} << 16, std::size_t{300}}) {
    RasterRules rules;
    rules.capacity.layer_samples = room;
    const TileScene scene(triangles, standard_pattern(2), rules);
    TileBuffers b(*scene.setup);
    begin_whole_pass(b);
    rasterize_opaque(b.job, b.visibility);
    b.alpha_tester.rasterize(b.job, b.batcher, b.visibility);
    const std::vector<std::int32_t> ids(b.visibility.id, b.visibility.id + 2 * sample_stride);
    if (whole.empty()) whole = ids;
    EXPECT_EQ(ids, whole);
  }
}

}  // namespace
}  // namespace zoneplate
