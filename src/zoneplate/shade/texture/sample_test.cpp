// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/sample.h"
#include "zoneplate/shade/texture/texture_view.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

// Two texels: black and white in sRGB, of which the mean in linear light is ½.
Texture black_and_white() {
  Rgba8Image image(2, 1);
  image(0, 0) = {0, 0, 0, 255};
  image(1, 0) = {255, 255, 255, 255};
  return Texture(image, TexelMeaning::Color);
}

TEST(TextureSample, ATexelCentreGivesTheTexel) {
  const Texture texture = black_and_white();
  EXPECT_EQ(sample(texture, {}, {0.25f, 0.5f}, {}, {}), (float4{0, 0, 0, 1}));
  EXPECT_EQ(sample(texture, {}, {0.75f, 0.5f}, {}, {}), (float4{1, 1, 1, 1}));
  EXPECT_NEAR(sample(texture, {}, {0.5f, 0.5f}, {}, {}).x, 0.5f, 1e-4f);
}

TEST(TextureSample, DerivativesChooseTheMipLevel) {
  // A footprint of the whole texture is filtered by its last level, the mean.
  const Texture texture = black_and_white();
  for (const float u : {0.1f, 0.25f, 0.6f}) EXPECT_NEAR(sample(texture, {}, {u, 0.5f}, {1, 0}, {0, 1}).y, 0.5f, 1e-3f);
}

TEST(TextureSample, AnisotropicProbesKeepTheShortAxis) {
  // The footprint is long in v, along which the texture is constant: u stays sharp.
  const Texture texture = black_and_white();
  const Sampler sampler{.anisotropy = 16};
  EXPECT_GT(sample(texture, sampler, {0.75f, 0.5f}, {0.01f, 0}, {0, 4}).x, 0.9f);
}

TEST(TextureSample, AnEnvironmentMapKeepsItsSun) {
  // Equirectangular radiance: it repeats along u and ends at the poles.
  Plane<float4> radiance(8, 4, float4{0.25f, 0.5f, 1, 1});
  radiance(0, 0) = {60000, 50016, 40000, 1};
  const Texture texture(radiance, TexelMeaning::Color);
  EXPECT_NE(texture.view().halves, nullptr);
  const Sampler sampler{.wrap_u = Wrap::Repeat, .wrap_v = Wrap::Clamp};
  EXPECT_EQ(sample(texture, sampler, {0.0625f, 0}, {}, {}), (float4{60000, 50016, 40000, 1}));
  for (const float seam : {0.0f, 1.0f, -3.0f})
    EXPECT_EQ(sample(texture, sampler, {seam, 0.1f}, {}, {}), (float4{30000.125f, 25008.25f, 20000.5f, 1}));
  // The coarsest mip level is the mean of all directions.
  const float mean = (60000 + 31 * 0.25f) / 32;
  EXPECT_NEAR(sample(texture, sampler, {0.3f, 0.7f}, {2, 0}, {0, 2}).x, mean, mean * 0x1p-10f);
}

}  // namespace
}  // namespace zoneplate
