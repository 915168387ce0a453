// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/opacity_map.h"

#include <gtest/gtest.h>

#include <limits>

namespace zoneplate {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(OpacityMap, AlphaIsTheMapsAlphaOrItsLuma) {
  const TexelImage color = Rgba8Image(2, 1, {10, 20, 30, 255});
  Rgba8Image grey(2, 1, {0, 0, 0, 255}), cut = grey;
  grey(1, 0) = {255, 0, 0, 255};
  cut(1, 0).a = 77;
  const auto alpha = [&](const TexelImage& map) { return with_opacity(&color, map).as<Rgba8>()(1, 0); };
  EXPECT_EQ(alpha(grey), (Rgba8{10, 20, 30, 54}));  // 0.2126 × 255 = 54.2
  EXPECT_EQ(alpha(cut), (Rgba8{10, 20, 30, 77}));
  EXPECT_FALSE(is_opaque(with_opacity(&color, grey)));
  EXPECT_TRUE(is_opaque(color));
}

TEST(OpacityMap, EveryCodeOfAlphaComesThrough) {
  Rgba8Image map(256, 1);
  for (int i = 0; i < 256; ++i) map(i, 0).a = static_cast<std::uint8_t>(i);
  Rgba16Image deep(4096, 1);
  for (int i = 0; i < 4096; ++i) deep(i, 0).a = static_cast<std::uint16_t>(i * 16);
  const TexelImage narrow = with_opacity(nullptr, map), wide = with_opacity(nullptr, deep);
  for (int i = 0; i < 256; ++i) EXPECT_EQ(narrow.as<Rgba8>()(i, 0), (Rgba8{255, 255, 255, map(i, 0).a}));
  for (int i = 0; i < 4096; ++i) EXPECT_EQ(wide.as<Rgba16>()(i, 0), (Rgba16{65535, 65535, 65535, deep(i, 0).a}));
}

TEST(OpacityMap, TheMorePreciseOfTheTwoDecides) {
  const TexelImage codes8 = Rgba8Image(1, 1, {1, 2, 3, 255}), codes16 = Rgba16Image(1, 1, {7, 8, 9, 1000});
  const TexelImage light = Plane<float4>(1, 1, float4{1e4f, nan, 2, 0.25f});
  EXPECT_EQ(with_opacity(&codes8, codes16), Rgba16Image(1, 1, {257, 514, 771, 1000}));
  EXPECT_EQ(with_opacity(&codes8, light), Rgba16Image(1, 1, {257, 514, 771, 16384}));
  EXPECT_EQ(with_opacity(&codes16, codes8), Rgba16Image(1, 1, {7, 8, 9, 514}));  // luma of 8 bits: 2 / 255
  const TexelImage lit = with_opacity(&light, codes16);
  EXPECT_EQ(lit.as<float4>()(0, 0).x, 1e4f);
  EXPECT_EQ(lit.as<float4>()(0, 0).w, 1000 / 65535.0f);
  EXPECT_EQ(with_opacity(nullptr, light), Plane<float4>(1, 1, float4{1, 1, 1, 0.25f}));
  for (const TexelImage* color : {&codes8, &codes16, &light})
    for (const TexelImage* map : {&codes8, &codes16, &light})
      EXPECT_EQ(with_opacity_memory(color, *map),
                with_opacity(color, *map).visit([](const auto& plane) { return plane.values().size_bytes(); }));
}

}  // namespace
}  // namespace zoneplate
