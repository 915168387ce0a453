// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/composite.h"

#include <gtest/gtest.h>

#include "zoneplate/raster/tile/tile_for_test.h"

namespace zoneplate {
namespace {

constexpr std::uint64_t all_blocks = ~std::uint64_t{0};

std::vector<Linear> pixels_of(const TileColors& colors) {
  std::vector<Linear> out;
  for (const Linear8& span : colors.color)
    for (std::size_t i = 0; i < 8; ++i) out.push_back(span.get(i));
  return out;
}

std::vector<TestTriangle> blended_over_opaque(std::uint32_t seed) {
  std::vector<TestTriangle> triangles = random_triangles(seed, 3, AlphaMode::Opaque);
  for (const TestTriangle& t : random_triangles(seed + 100, 30, AlphaMode::Blend)) triangles.push_back(t);
  for (int i = 0; i < 4; ++i)
    triangles.push_back(full_tile(0.92f + 0.01f * static_cast<float>(i), {1, 0.5f, 0.25f, 0.5f}, AlphaMode::Blend));
  return triangles;
}

// The routes of composite.h are optimizations of the last one, the compositing of single pixels.
TEST(Composite, BlocksSpansAndPixelsGiveTheSameBits) {
  std::uint64_t by_blocks = 0;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const std::vector<TestTriangle> triangles = blended_over_opaque(seed);
    const auto composite = [&](int route, std::size_t room) {
      RasterRules rules;
      rules.capacity.layer_samples = room;
      const TileScene scene(triangles, standard_pattern(4), rules);
      TileBuffers b(*scene.setup);
      begin_whole_pass(b);
      rasterize_opaque(b.job, b.visibility);
      shade_opaque(b.job, b.visibility, b.batcher, b.opaque, b.colors);
      resolve_fragments(b.job, b.opaque, b.colors);
      std::uint64_t others = all_blocks;
      if (route == 0) others = b.blocks.composite(b.job, b.visibility, b.batcher, b.opaque, b.colors);
      by_blocks += route == 0 && others != all_blocks;
      b.spans.composite(b.job, b.visibility, b.batcher, others, b.opaque, b.pixels, b.colors);
      return pixels_of(b.colors);
    };
    const std::vector<Linear> blocks = composite(0, std::size_t{1} << 16);
    EXPECT_EQ(composite(1, std::size_t{1} << 16), blocks);  // by spans
    EXPECT_EQ(composite(1, 40), blocks);                    // single pixels, some of them peeled
  }
  EXPECT_GT(by_blocks, 0u);
}

TEST(Composite, LayersOfAPixelByHand) {
  // From far to near: half red, a quarter green; over white.
  const TileScene scene({full_tile(0.1f, {1, 1, 1, 1}), full_tile(0.5f, {0, 1, 0, 0.25f}, AlphaMode::Blend),
                         full_tile(0.3f, {1, 0, 0, 0.5f}, AlphaMode::Blend)},
                        standard_pattern(1));
  TileBuffers b(*scene.setup);
  begin_with_visibility(b, [](int, int x, int) { return x < 32 ? 0 : no_primitive; });
  std::fill_n(b.visibility.depth, tile_pixels, 0.1f);
  std::vector<Linear> results(tile_pixels);
  b.pixels.for_pixels(b.job, {0, 0, tile_size, tile_size}, nullptr, b.visibility, b.batcher,
                      [&](const PixelLayers& layers) {
                        const bool is_left = layers.pixel % tile_size < 32;
                        Linear behind = is_left ? Linear{1, 1, 1, 1} : Linear{0, 0, 0, 0};
                        b.pixels.composite(b.job, layers, b.visibility, b.batcher, &behind);
                        results[layers.pixel] = behind;
                      });
  EXPECT_EQ(results[0], (Linear{0.75f, 0.625f, 0.375f, 1}));
  EXPECT_EQ(results[40], (Linear{0.375f, 0.25f, 0, 0.625f}));
}

}  // namespace
}  // namespace zoneplate
