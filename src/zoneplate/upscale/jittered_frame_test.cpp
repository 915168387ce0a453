// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/jittered_frame.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/math/random.h"
#include "zoneplate/upscale/scatter_rows.h"

namespace zoneplate::upscale {
namespace {

TEST(JitteredFrame, TheBackgroundKeepsItsColourUnderEveryToneMapping) {
  const float4 dark{0.05f, 0.1f, 0.02f, 1}, blue{0.3f, 0.45f, 0.7f, 1}, light{0.85f, 0.8f, 0.75f, 1};
  for (const ToneMapping mapping :
       {ToneMapping::None, ToneMapping::Aces, ToneMapping::Neutral, ToneMapping::Agx, ToneMapping::Filmic})
    for (const float exposure : {1.0f, 2.5f})
      for (const float4& background : {default_background, dark, blue, light}) {
        const DisplayOptions display{.mapping = mapping, .exposure = exposure, .background = background};
        const Display c =
            make_display(over_background(LinearImage(1, 1, Linear{0, 0, 0, 0}), display, "test"), display)(0, 0);
        EXPECT_NEAR(c.r, background.x, 0.5 / 255) << static_cast<int>(mapping);
        EXPECT_NEAR(c.g, background.y, 0.5 / 255) << static_cast<int>(mapping);
        EXPECT_NEAR(c.b, background.z, 0.5 / 255) << static_cast<int>(mapping);
        EXPECT_EQ(c.a, 1);
      }
}

TEST(JitteredFrame, ACropIsCopiedIntoTheMemoryOfItsSize) {
  LinearImage image(37, 41);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 37; ++x) image(x, y) = {static_cast<float>(x), static_cast<float>(y), 0, 1};
  for (const auto& crop : {std::optional<Crop>(), std::optional(Crop{5, 7, 20, 33})})
    for (const int width : {0, 20, 37}) {
      const LinearImage made = cropped(image, crop, LinearImage(width, width == 20 ? 33 : 41, {9, 9, 9, 9}));
      const Crop part = crop.value_or(Crop{0, 0, 37, 41});
      ASSERT_EQ(made.width(), part.width);
      ASSERT_EQ(made.height(), part.height);
      for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x) EXPECT_EQ(made(x, y), image(part.x + x, part.y + y));
      EXPECT_EQ(cropped(LinearImage(image), crop), made);
    }
}

TEST(ScatterRows, VisitsEachRowForEveryBlockThatItReaches) {
  constexpr int height = 200;
  const auto target = [](int y) { return static_cast<int>(hash(static_cast<std::uint32_t>(y)) % 240) - 20; };
  std::vector<RowRange> rows(height);
  std::vector<std::vector<int>> expected(height), found(height);
  for (int y = 0; y < height; ++y)
    for (const int to : {target(y), target(y) + 1}) {
      if (to < 0 || to >= height) continue;
      rows[static_cast<std::size_t>(y)].add(to);
      expected[static_cast<std::size_t>(to)].push_back(y);
    }
  const auto begin = [&](int first, int after) {
    for (int to = first; to < after; ++to) found[static_cast<std::size_t>(to)] = {};
  };
  scatter_rows(rows, begin, [&](int y, int first, int after) {
    for (const int to : {target(y), target(y) + 1})
      if (to >= first && to < after) found[static_cast<std::size_t>(to)].push_back(y);
  });
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace zoneplate::upscale
