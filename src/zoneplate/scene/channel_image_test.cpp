// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/channel_image.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

TEST(ChannelImage, JoinsTheRedsOfTwoImages) {
  Rgba8Image rough(2, 1, {10, 1, 2, 3});
  rough(1, 0).r = 20;
  const TexelImage roughness = rough, metallic = Rgba8Image(1, 1, {30, 4, 5, 6});
  const TexelImage both = with_metallic_roughness(&roughness, &metallic);
  EXPECT_EQ(both.as<Rgba8>()(0, 0), (Rgba8{255, 10, 30, 255}));
  EXPECT_EQ(both.as<Rgba8>()(1, 0), (Rgba8{255, 20, 30, 255}));
  EXPECT_EQ(with_metallic_roughness_memory(&roughness, &metallic), 8u);
  EXPECT_EQ(with_metallic_roughness(nullptr, &metallic).as<Rgba8>()(0, 0), (Rgba8{255, 255, 30, 255}));
  EXPECT_EQ(with_metallic_roughness(&metallic, nullptr).as<Rgba8>()(0, 0), (Rgba8{255, 30, 255, 255}));
}

TEST(ChannelImage, KeepsThePrecisionOfDeepImages) {
  const TexelImage roughness = Rgba16Image(1, 1, {32768, 0, 0, 65535});
  const TexelImage metallic = Plane<float4>(1, 1, float4{0.25f, 9, 9, 1});
  const TexelImage both = with_metallic_roughness(&roughness, &metallic);
  EXPECT_EQ(both.as<float4>()(0, 0), (float4{1, 32768.0f / 65535, 0.25f, 1}));
  EXPECT_EQ(with_metallic_roughness_memory(&roughness, &metallic), 16u);
}

}  // namespace
}  // namespace zoneplate
