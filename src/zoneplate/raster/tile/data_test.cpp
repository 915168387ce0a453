// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/data.h"

#include <gtest/gtest.h>

#include "zoneplate/raster/tile/tile_for_test.h"

namespace zoneplate {
namespace {

struct Planes {
  Plane<float> depth{tile_size, tile_size};
  Plane<float2> uv{tile_size, tile_size};
  Plane<std::uint32_t> instance{tile_size, tile_size};
  LinearImage color{tile_size, tile_size};
};

const std::vector<TestTriangle> two = {full_tile(0.25f, {1, 0, 0, 1}), full_tile(0.5f, {0, 1, 0, 1})};

TEST(DataStage, DepthAndIdsNeedNoShading) {
  Planes planes;
  Target target;
  target.reversed_depth = &planes.depth;
  target.instance = &planes.instance;
  const TileScene scene(two, standard_pattern(4), {}, target);
  TileBuffers b(*scene.setup);
  render_tile(0, b);
  EXPECT_EQ(planes.depth(10, 20), 0.5f);
  EXPECT_EQ(planes.instance(10, 20), 1u);
  EXPECT_EQ(b.batcher.shaded(), 0u);
}

TEST(DataStage, AttributesShadeOneFragmentPerPixel) {
  Planes planes;
  Target target;
  target.uv = &planes.uv;
  const TileScene scene(two, standard_pattern(4), {}, target);
  TileBuffers b(*scene.setup);
  render_tile(0, b);
  EXPECT_EQ(planes.uv(10, 20), (float2{1, 128}));
  EXPECT_EQ(b.batcher.shaded(), 0u);
  EXPECT_EQ(b.batcher.evaluated(), static_cast<std::uint64_t>(tile_pixels));
}

TEST(DataStage, DataAreTheSameWithAndWithoutColour) {
  std::vector<TestTriangle> triangles = random_triangles(3, 20, AlphaMode::Opaque);
  for (const bool is_per_sample : {false, true}) {
    Planes alone, beside;
    for (Planes* planes : {&alone, &beside}) {
      Target target;
      target.is_per_sample = is_per_sample;
      target.uv = &planes->uv;
      target.reversed_depth = &planes->depth;
      target.instance = &planes->instance;
      if (planes == &beside) target.color = &planes->color;
      const TileScene scene(triangles, grid_pattern(is_per_sample ? 5 : 2), {}, target);
      TileBuffers b(*scene.setup);
      render_tile(0, b);
    }
    EXPECT_EQ(alone.uv, beside.uv);
    EXPECT_EQ(alone.depth, beside.depth);
    EXPECT_EQ(alone.instance, beside.instance);
  }
}

TEST(DataStage, TheNearestSampleDecides) {
  const TileScene scene(two, standard_pattern(4));
  TileBuffers b(*scene.setup);
  begin_whole_pass(b);
  b.data.nearest.assign(tile_pixels, NearestSurface{});
  fill_visibility(b.job, b.visibility, [](int s, int, int) { return s == 2 ? 1 : 0; });
  b.visibility.depth[2 * sample_stride] = 0.75f;
  list_fragments(b.job, b.visibility, b.opaque);
  collect_nearest_surfaces(b.job, b.visibility, b.opaque, false, b.data);
  EXPECT_EQ(b.data.nearest[0].id, 1);
  EXPECT_EQ(b.data.nearest[0].depth, 0.75f);
  EXPECT_EQ(b.data.nearest[1].id, 0);  // equal depths: the earlier triangle
  EXPECT_EQ(b.data.nearest[1].first_owns, 3);
}

}  // namespace
}  // namespace zoneplate
