// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/fxaa/fxaa.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/post/fxaa/search.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

constexpr int all_presets[] = {10, 11, 12, 13, 14, 15, 20, 21, 22,
                               23, 24, 25, 26, 27, 28, 29, 39, FxaaOptions::console};

TEST(Fxaa, ChartIsTheOneThatOthersWereGiven) {
  const Rgba8Image chart = chart64();
  std::uint64_t sum = 0;
  for (const Rgba8& c : chart.values()) sum += static_cast<std::uint64_t>(c.r) + c.g + c.b;
  EXPECT_EQ(sum, 1760660u);
}

/// A pixel of the chart at which the original has another colour: the original's codes minus ours.
struct Difference {
  int x, y, r, g, b;
};

/// The results of the original's presets for the chart: a hash of red, green and blue, and the pixels at which ours
/// differ.
///
/// A difference of one code is a rounding of the blended colour. Greater differences are ties: a search reads a luma
/// that differs from the pixel's by exactly a quarter of the gradient, so that rounding decides: in 16-bit fixed point
/// there, in double here. Source: NVIDIA's FXAA 3.11 as FXAAShader of three.js 0.137.5, run in headless Chromium.
struct Original {
  int preset;
  std::uint64_t hash;
  std::vector<Difference> differences;
};
const Original originals[] = {
    {10, 0xb8fb41ec893bb944u, {{42, 0, -1, 0, 0},  {43, 2, -5, -12, -37}, {43, 6, -1, -1, -1}, {0, 8, 0, 0, -1},
                               {1, 8, 0, 0, -1},   {2, 8, 0, -1, 0},      {3, 8, 0, -1, 0},    {7, 9, 7, -40, -12},
                               {10, 10, 0, 0, -1}, {11, 10, 0, -1, 0},    {12, 10, 0, -1, 0},  {15, 11, 0, -1, 0},
                               {16, 11, 0, -1, 0}, {47, 11, 0, -1, 0},    {20, 12, 0, -1, 0},  {21, 12, 0, -1, 0},
                               {24, 13, 0, -1, 0}, {25, 13, 0, -1, 0},    {28, 14, 0, -1, 0},  {29, 14, 0, -1, 0},
                               {30, 14, 0, -1, 0}, {31, 14, -1, -1, -1},  {47, 16, 0, -1, 0},  {33, 18, 1, 3, 11},
                               {48, 18, 0, 0, -1}, {35, 20, 1, 3, 11},    {44, 20, 1, 3, 11},  {31, 24, 1, 0, 0}}},
    {12, 0x9dc812b25e6acbddu, {{43, 3, -4, -6, -19}, {8, 9, 3, -19, -6}, {31, 24, 1, 0, 0}}},
    {15, 0x9b30eb55162af078u, {{43, 3, -4, -6, -19}, {8, 9, 3, -19, -6}, {31, 24, 1, 0, 0}}},
    {20,
     0x3d90f176c41a9739u,
     {{43, 2, -4, -9, -28},
      {7, 9, 4, -24, -7},
      {9, 10, 7, -44, -13},
      {33, 18, 0, 1, 2},
      {35, 20, 0, 1, 2},
      {44, 20, 0, 1, 2},
      {31, 24, 1, 0, 0}}},
    {29, 0x858d9bcadea941ccu, {{43, 3, -4, -6, -19}, {8, 9, 3, -19, -6}, {31, 24, 1, 0, 0}}},
    {39,
     0x3ff2b52b920887c1u,
     {{6, 6, -1, 0, 0}, {9, 6, -1, 0, 0}, {9, 7, -1, 0, 0}, {9, 8, -1, 0, 0}, {31, 24, 1, 0, 0}}},
};

/// True if a search from this pixel may read a luma that differs by exactly a quarter of the gradient.
bool has_tie(const Rgba8Image& image, int x, int y) {
  const auto luma = [&](int i, int j) { return int{image(std::clamp(i, 0, 63), std::clamp(j, 0, 63)).g}; };
  for (const auto& [ax, ay] : {std::pair{1, 0}, {0, 1}})
    for (const int side : {-1, 1}) {
      const auto pair = [&, ax = ax, ay = ay](int i) {
        return luma(x + i * ax, y + i * ay) + luma(x + i * ax + side * ay, y + i * ay + side * ax);
      };
      const int gradient = std::abs(luma(x + side * ay, y + side * ax) - luma(x, y));
      for (const int d : {-7, -5, -3, -2, 2, 3, 5, 7})
        if (gradient > 20 && std::abs(pair(d >> 1) + pair((d + 1) >> 1) - 2 * pair(0)) == gradient) return true;
    }
  return false;
}

TEST(Fxaa, PresetsEqualTheOriginalButForTies) {
  for (const Original& original : originals) {
    Rgba8Image out = apply_fxaa(chart64(), {.preset = original.preset, .is_green_luma = true});
    for (const auto& [x, y, r, g, b] : original.differences) {
      Rgba8& c = out(x, y);
      c = {static_cast<std::uint8_t>(c.r + r), static_cast<std::uint8_t>(c.g + g), static_cast<std::uint8_t>(c.b + b)};
      if (std::max({std::abs(r), std::abs(g), std::abs(b)}) > 1) {
        EXPECT_TRUE(has_tie(chart64(), x, y)) << x << ", " << y;
      }
    }
    EXPECT_EQ(hash_of_colors(out), original.hash) << original.preset;
  }
}

TEST(Fxaa, OutputsHaveTheirBits) {
  const Rgba8Image image = random_shapes(200, 150, 1);
  const auto hash = [&](const FxaaOptions& o) { return hash_of(apply_fxaa(image, o)); };
  EXPECT_EQ(hash({.preset = 10}), 0xf8f625c2c3341330u);
  EXPECT_EQ(hash({.preset = 12}), 0xf99f6c4278f94f0u);
  EXPECT_EQ(hash({.preset = 39, .threshold = 0.063, .least = 0.0312}), 0xa5f5e3538c387d24u);
  EXPECT_EQ(hash({.preset = 12, .mixes_light = true}), 0xeb954291c55f56ffu);
  EXPECT_EQ(hash({.preset = FxaaOptions::console, .threshold = 0.125, .least = 0.05}), 0x30953c3aa53fa750u);
}

TEST(Fxaa, InstructionSetsAndThreadsLeaveNoTrace) {
  const Rgba8Image image = random_shapes(203, 77, 2);
  for (const int preset : all_presets) {
    const Rgba8Image expected = with_isa(Isa::Scalar, [&] { return apply_fxaa(image, {.preset = preset}); });
    for (const Isa isa : supported_isas())
      with_isa(isa,
               [&] { EXPECT_EQ(apply_fxaa(image, {.preset = preset}), expected) << preset << ", " << name_of(isa); });
    for (const int threads : {1, 2, 7})
      with_threads(threads, [&] { EXPECT_EQ(apply_fxaa(image, {.preset = preset}), expected) << preset << threads; });
  }
}

TEST(Fxaa, LumaIsRec601Rounded) {
  std::vector<Rgba8> pixels(77);
  for (std::uint32_t i = 0; Rgba8 & p : pixels) {
    const std::uint32_t h = hash(i++);
    p = {static_cast<std::uint8_t>(h), static_cast<std::uint8_t>(h >> 8), static_cast<std::uint8_t>(h >> 16)};
  }
  for (const Isa isa : supported_isas()) {
    const FxaaKernels& kernels = FxaaKernels::of(isa);
    for (std::size_t n = 0; n <= pixels.size(); ++n) {
      std::vector<std::uint8_t> luma(n + 1, 7), green = luma;
      kernels.luma_row(&pixels[0].r, luma.data(), n);
      kernels.green_row(&pixels[0].r, green.data(), n);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_NEAR(luma[i], 0.299 * pixels[i].r + 0.587 * pixels[i].g + 0.114 * pixels[i].b, 0.5001);
        ASSERT_EQ(green[i], pixels[i].g);
      }
      ASSERT_EQ(luma[n], 7);
      ASSERT_EQ(green[n], 7);
    }
  }
}

TEST(Fxaa, ContrastBelowEitherThresholdIsLeftAlone) {
  // A step from `low` to `high` in a uniform field changes only if its range is at least max(least, high × share).
  for (const auto& [share, least] :
       {std::pair{0.333, 0.0833}, {0.25, 0.0833}, {0.166, 0.0833}, {0.125, 0.0625}, {0.063, 0.0312}})
    for (int high = 1; high < 256; ++high)
      for (int low = std::max(0, high - 90); low < high; ++low) {
        const auto code = [](int v) { return static_cast<std::uint8_t>(v); };
        const Rgba8 dark{code(low), code(low), code(low)}, bright{code(high), code(high), code(high)};
        const Rgba8Image image = make_codes(8, 4, [&](int x, int y) { return x > 3 + (y > 1) ? bright : dark; });
        const bool is_seen = high - low >= least * 255 && high - low >= high * share;
        // A step of a few codes may be rounded to no change.
        if (high - low > 3) {
          ASSERT_EQ(apply_fxaa(image, {.threshold = share, .least = least}) != image, is_seen) << low << " " << high;
        }
      }
}

TEST(Fxaa, MoreSearchBringsALevelEdgeNearerToItsCoverage) {
  // A half-plane of slope 1/24: the reference is the exact area per pixel, and longer searches are closer to it.
  const auto area = [](int x, int y) { return std::clamp((x + 0.5) / 24 + 20 - y, 0.0, 1.0); };
  const Rgba8Image image = make_codes(192, 40, [&](int x, int y) {
    const auto v = static_cast<std::uint8_t>(area(x, y) >= 0.5 ? 230 : 20);
    return Rgba8{v, v, v};
  });
  double last = 1e9;
  for (const int preset : {10, 12, 29}) {
    const Rgba8Image out = apply_fxaa(image, {.preset = preset, .subpixel = 0});
    double error = 0;
    for (int y = 0; y < 40; ++y)
      for (int x = 32; x < 160; ++x) error += std::abs(out(x, y).g - (20 + 210 * area(x, y)));
    EXPECT_LT(error, last) << preset;
    last = error;
  }
}

}  // namespace
}  // namespace zoneplate::antialias
