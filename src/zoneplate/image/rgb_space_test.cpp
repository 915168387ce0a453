// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/rgb_space.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

constexpr std::array<double, 8> ap0 = {0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767};

void expect_near(const Matrix3& found, const Matrix3& expected, double most) {
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found[i], expected[i], most) << i;
}

std::string refusal(const ColorProfile& profile) {
  try {
    make_rgb_space(profile);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Linear light_at(const RgbSpace& space, float value) {
  return light_of(DisplayImage(1, 1, {value, value, value, 1}), space)(0, 0);
}

TEST(RgbSpace, MatricesAreThoseOfThePublishedPrimaries) {
  expect_near(rec709_from({0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329}), identity3, 1e-12);
  // Display P3, as CSS Color 4 has it.
  expect_near(rec709_from({0.68, 0.32, 0.265, 0.69, 0.15, 0.06, 0.3127, 0.329}),
              {1.2249402, -0.2249402, 0, -0.0420570, 1.0420570, 0, -0.0196376, -0.0786361, 1.0982736}, 1e-5);
  // ACES 2065-1: white stays white.
  const Matrix3 aces = rec709_from(ap0);
  for (const std::size_t row : {0u, 3u, 6u}) EXPECT_NEAR(aces[row] + aces[row + 1] + aces[row + 2], 1, 1e-9);
  EXPECT_NEAR(aces[0], 2.52, 0.01);
}

TEST(RgbSpace, CurvesAreThoseOfTheStandards) {
  EXPECT_EQ(light_at(*make_rgb_space({.gamma = 100000}), 0.25f).g, 0.25f);
  EXPECT_NEAR(light_at(*make_rgb_space({.gamma = 50000}), 0.5f).g, 0.25f, 1e-6f);
  const RgbSpacePtr pq = make_rgb_space({.cicp = {{9, 16, 0, 1}}});
  EXPECT_NEAR(light_at(*pq, 1).g, 10000.0f / 203, 0.01f);
  EXPECT_NEAR(light_at(*pq, 0.5081f).g, 100.0f / 203, 0.002f);  // 100 cd/m² (ST 2084)
  EXPECT_NEAR(light_at(*pq, 0.58f).g, 1, 0.01f);                // the reference white of BT.2408
  const RgbSpacePtr hlg = make_rgb_space({.cicp = {{9, 18, 0, 1}}});
  EXPECT_NEAR(light_at(*hlg, 0.75f).g, 1, 1e-5f);
  EXPECT_NEAR(light_at(*hlg, 0.5f).g / light_at(*hlg, 1).g, 1.0f / 12, 1e-4f);
  const RgbSpacePtr narrow = make_rgb_space({.cicp = {{1, 13, 0, 0}}});
  EXPECT_EQ(light_at(*narrow, 16.0f / 255).g, 0);
  EXPECT_NEAR(light_at(*narrow, 235.0f / 255).g, 1, 1e-6f);
  EXPECT_NEAR(light_at(*make_rgb_space({.cicp = {{1, 1, 0, 1}}}), 0.5f).g,
              std::pow((0.5f + 0.0993f) / 1.0993f, 1 / 0.45f), 1e-5f);
}

TEST(RgbSpace, EveryCodeComesBack) {
  const ColorProfile profiles[] = {{.gamma = 100000},         {.gamma = 55556},           {.cicp = {{9, 16, 0, 1}}},
                                   {.cicp = {{9, 18, 0, 1}}}, {.cicp = {{12, 13, 0, 1}}}, {.cicp = {{1, 1, 0, 1}}},
                                   {.cicp = {{11, 17, 0, 1}}}};
  Rgba16Image codes(256, 256);
  for (std::size_t i = 0; i < 65536; ++i) {
    const auto code = static_cast<std::uint16_t>(i);
    codes.values()[i] = {code, static_cast<std::uint16_t>(65535 - code), code, 65535};
  }
  DisplayImage values(256, 256);
  std::ranges::transform(codes.values(), values.values().begin(), [](Rgba16 c) {
    return Display{static_cast<float>(c.r) / 65535, static_cast<float>(c.g) / 65535, static_cast<float>(c.b) / 65535,
                   1};
  });
  for (const ColorProfile& profile : profiles) {
    const RgbSpacePtr space = make_rgb_space(profile);
    ASSERT_TRUE(can_encode(*space));
    EXPECT_EQ(quantize16(codes_of(light_of(values, *space), *space)), codes);
  }
}

TEST(RgbSpace, LightOfOtherPrimariesHasNoLimits) {
  ColorProfile profile;
  std::ranges::transform(ap0, profile.chromaticities.emplace().begin(), [](double v) { return static_cast<float>(v); });
  const RgbSpacePtr space = make_rgb_space(profile);
  LinearImage light(1, 1, {-2, 1000, 3, 0.5f});
  const LinearImage stored = light;
  convert_to_rec709(light, *space);
  EXPECT_NEAR(light(0, 0).g,
              -2 * space->rec709_from_rgb[3] + 1000 * space->rec709_from_rgb[4] + 3 * space->rec709_from_rgb[5], 1e-3);
  EXPECT_EQ(light(0, 0).a, 0.5f);
  EXPECT_EQ(stored(0, 0), (Linear{-2, 1000, 3, 0.5f}));
}

TEST(RgbSpace, SpellingsOfSrgbAreStandard) {
  const std::array<std::uint32_t, 8> srgb = {31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
  EXPECT_EQ(make_rgb_space({}), nullptr);
  EXPECT_TRUE(make_rgb_space({.cicp = {{1, 13, 0, 1}}})->is_standard);
  EXPECT_TRUE(make_rgb_space({.gamma = 45455})->is_standard);
  EXPECT_TRUE(make_rgb_space({.gamma = 45455, .primaries = srgb})->is_standard);
  EXPECT_TRUE(make_rgb_space({.primaries = srgb})->is_standard);
  EXPECT_FALSE(make_rgb_space({.gamma = 55556})->is_standard);
  EXPECT_FALSE(make_rgb_space({.cicp = {{12, 13, 0, 1}}})->is_standard);
  EXPECT_TRUE(is_same(nullptr, make_rgb_space({.gamma = 45455})));
  EXPECT_TRUE(is_same(make_rgb_space({.gamma = 100000}), make_rgb_space({.gamma = 100000})));
  EXPECT_FALSE(is_same(make_rgb_space({.gamma = 100000}), nullptr));
}

TEST(RgbSpace, WhatMeansNothingIsRefused) {
  EXPECT_EQ(refusal({.gamma = 0}), "has the value 0, expected 1000 to 10000000");
  EXPECT_EQ(refusal({.primaries = {{0, 0, 0, 0, 0, 0, 0, 0}}}), "has primaries or a white of no colour");
  EXPECT_EQ(refusal({.primaries = {{90000, 5000, 64000, 33000, 30000, 60000, 15000, 6000}}}),
            "has a white outside its primaries");
  EXPECT_EQ(refusal({.cicp = {{3, 13, 0, 1}}}), "has primaries 3, which are not read");
  EXPECT_EQ(refusal({.cicp = {{1, 99, 0, 1}}}), "has transfer function 99, which is not read");
  EXPECT_EQ(refusal({.cicp = {{1, 13, 1, 1}}}), "has matrix 1, expected 0 (RGB)");
  EXPECT_EQ(refusal({.chromaticities = {{NAN, 0, 0, 1, 0, 0, 0.3f, 0.3f}}}), "has primaries or a white of no colour");
}

}  // namespace
}  // namespace zoneplate
