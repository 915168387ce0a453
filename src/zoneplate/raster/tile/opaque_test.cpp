// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/opaque.h"

#include <gtest/gtest.h>

#include "zoneplate/raster/tile/tile_for_test.h"

namespace zoneplate {
namespace {

const Linear red = {1, 0, 0, 1}, green = {0, 1, 0, 1};
const std::vector<TestTriangle> two_opaque = {full_tile(0.5f, red), full_tile(0.4f, green)};

// The left 20 columns belong to triangle 0, the next 20 to triangle 1, of column 40 samples 0 and 1 to triangle 1, and
// nothing covers the rest.
std::int32_t owner_of_columns(int s, int x, int) {
  return x < 20 ? 0 : x < 40 || (x == 40 && s < 2) ? 1 : no_primitive;
}

Linear color_at(const TileColors& colors, int x, int y) {
  return colors.color[static_cast<std::size_t>(y * 8 + x / 8)].get(static_cast<std::size_t>(x % 8));
}

TEST(OpaqueStage, ShadesOncePerSurfaceAndPixel) {
  const TileScene scene(two_opaque, standard_pattern(4));
  TileBuffers b(*scene.setup);
  begin_with_visibility(b, owner_of_columns);
  shade_opaque(b.job, b.visibility, b.batcher, b.opaque, b.colors);
  resolve_fragments(b.job, b.opaque, b.colors);
  for (int y = 0; y < tile_size; ++y) {
    EXPECT_EQ(color_at(b.colors, 19, y), red);
    EXPECT_EQ(color_at(b.colors, 20, y), green);
    EXPECT_EQ(color_at(b.colors, 40, y), (Linear{0, 0.5f, 0, 0.5f}));
    EXPECT_EQ(color_at(b.colors, 41, y), (Linear{0, 0, 0, 0}));
  }
  EXPECT_EQ(b.batcher.shaded(), 41u * tile_size);
}

TEST(OpaqueStage, ShadesEverySampleAtRateSample) {
  Target target;
  target.is_per_sample = true;
  const TileScene scene(two_opaque, standard_pattern(4), {}, target);
  TileBuffers b(*scene.setup);
  begin_with_visibility(b, owner_of_columns);
  shade_opaque(b.job, b.visibility, b.batcher, b.opaque, b.colors);
  resolve_fragments(b.job, b.opaque, b.colors);
  EXPECT_EQ(color_at(b.colors, 40, 3), (Linear{0, 0.5f, 0, 0.5f}));
  EXPECT_EQ(b.batcher.shaded(), (40u * 4 + 2) * tile_size);
}

TEST(OpaqueStage, FragmentsOfAPixelFollowTheirFirstSamples) {
  const TileScene scene(two_opaque, standard_pattern(4));
  TileBuffers b(*scene.setup);
  begin_with_visibility(b, [](int s, int, int) { return s == 1 ? no_primitive : s == 0 ? 1 : 0; });
  std::vector<Fragment> fragments;
  add_pixel(b.job, b.visibility, 64 * 3 + 5, fragments);
  ASSERT_EQ(fragments.size(), 2u);
  EXPECT_EQ(fragments[0].id, 1);
  EXPECT_EQ(fragments[0].samples, 1u);
  EXPECT_EQ(fragments[1].id, 0);
  EXPECT_EQ(fragments[1].samples, 12u);
  const SamplePattern pattern = standard_pattern(4);
  EXPECT_EQ(fragments[0].x, 5 * 256 + pattern[0].x);  // one sample: shaded there
  EXPECT_EQ(fragments[0].y, 3 * 256 + pattern[0].y);
}

TEST(OpaqueStage, WeightsApplyToSamples) {
  Target target;
  target.weights = {1, 2, 3, 10};
  const TileScene scene(two_opaque, standard_pattern(4), {}, target);
  TileBuffers b(*scene.setup);
  begin_with_visibility(b, [](int s, int, int) { return s == 3 ? 1 : 0; });
  shade_opaque(b.job, b.visibility, b.batcher, b.opaque, b.colors);
  resolve_fragments(b.job, b.opaque, b.colors);
  EXPECT_EQ(color_at(b.colors, 30, 30), (Linear{6.0f / 16, 10.0f / 16, 0, 1}));
}

}  // namespace
}  // namespace zoneplate
