// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/output.h"

#include <gtest/gtest.h>

#include "zoneplate/raster/tile/tile_for_test.h"

namespace zoneplate {
namespace {

TEST(OutputStage, WritesThePixelsOfTheTargetAlone) {
  // Any part of the tile: its left and right ends need not lie on spans.
  for (const int left : {0, 3, 8, 13})
    for (const int right : {14, 16, 21, 64}) {
      LinearImage image(tile_size, tile_size, Linear{-1, -1, -1, -1});
      Target planes;
      planes.color = &image;
      const TileScene scene({full_tile(0.5f, {})}, standard_pattern(1), {}, planes);
      TileBuffers b(*scene.setup);
      begin_whole_pass(b);
      b.job.drawn = {left, 5, right, 7};
      b.colors.color.resize(tile_pixels / 8);
      for (int i = 0; i < tile_pixels; ++i)
        b.colors.color[static_cast<std::size_t>(i / 8)].set(static_cast<std::size_t>(i % 8),
                                                            {static_cast<float>(i), 0, 0, 1});
      write_colors(b.job, b.colors);
      for (int y = 0; y < tile_size; ++y)
        for (int x = 0; x < tile_size; ++x) {
          const float expected = b.job.drawn.contains(x, y) ? static_cast<float>(y * tile_size + x) : -1;
          ASSERT_EQ(image(x, y).r, expected) << x << ' ' << y << ' ' << left << ' ' << right;
        }
    }
}

TEST(OutputStage, LeavesWrittenSpansAsTheyAre) {
  constexpr Rgba8 before{1, 2, 3, 4}, black{0, 0, 0, 255};
  for (int written = 0; written < 256; ++written) {
    Rgba8Image image(tile_size, tile_size, before);
    const DisplayTransform transform({});
    Target planes;
    planes.display8 = &image, planes.display_transform = &transform;
    const TileScene scene({full_tile(0.5f, {})}, standard_pattern(1), {}, planes);
    TileBuffers b(*scene.setup);
    begin_whole_pass(b);
    b.job.drawn = {0, 9, tile_size, 10};
    b.colors.color.resize(tile_pixels / 8);
    for (std::size_t i = 0; i < tile_pixels; ++i) b.colors.color[i / 8].set(i % 8, {0, 0, 0, 1});
    b.colors.written_spans[9] = static_cast<std::uint8_t>(written);
    write_colors(b.job, b.colors);
    for (int x = 0; x < tile_size; ++x)
      ASSERT_EQ(image(x, 9), (written >> x / 8 & 1) != 0 ? before : black) << written << ' ' << x;
  }
}

}  // namespace
}  // namespace zoneplate
