#include "zoneplate/antialias/fxaa.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/fxaa_kernels.h"
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

/// Where other pixels than these differ by more than one code, the method is another one.
///
/// At each of them a search looks at a luma that differs from the pixel's by exactly a quarter of the gradient, so
/// that rounding decides: in 16-bit fixed point there, in double here.
struct Tie {
  int preset;
  std::vector<std::pair<int, int>> pixels;
};
const Tie ties[] = {
    {10, {{43, 2}, {7, 9}, {33, 18}, {35, 20}, {44, 20}}},          {12, {{43, 3}, {8, 9}}}, {15, {{43, 3}, {8, 9}}},
    {20, {{43, 2}, {7, 9}, {9, 10}, {33, 18}, {35, 20}, {44, 20}}}, {29, {{43, 3}, {8, 9}}}, {39, {}}};

/// True if a search from this pixel may meet a luma that is exactly a quarter of the gradient off.
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
  for (const auto& [preset, expected] : ties) {
    const auto golden = golden_picture("fxaa" + std::to_string(preset) + "_three_r137.png");
    if (!golden) GTEST_SKIP() << "no outputs of other implementations here";
    const Rgba8Image out = apply_fxaa(chart64(), {.preset = preset, .is_green_luma = true});
    std::vector<std::pair<int, int>> found;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const Rgba8 a = out(x, y), b = (*golden)(x, y);
        if (std::abs(a.r - b.r) > 1 || std::abs(a.g - b.g) > 1 || std::abs(a.b - b.b) > 1) found.emplace_back(x, y);
      }
    EXPECT_EQ(found, expected) << preset;
    for (const auto& [x, y] : found) EXPECT_TRUE(has_tie(chart64(), x, y)) << x << ", " << y;
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
    const Rgba8Image expected = apply_fxaa(image, {.preset = preset, .isa = Isa::Scalar});
    for (const Isa isa : supported_isas())
      EXPECT_EQ(apply_fxaa(image, {.preset = preset, .isa = isa}), expected) << preset << ", " << name_of(isa);
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
    const FxaaKernels& kernels = pick(isa, scalar::fxaa_kernels);
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
  // A step from `low` to `high` in a field: changed just if the range reaches max(least, high × share).
  for (const auto& [share, least] :
       {std::pair{0.333, 0.0833}, {0.25, 0.0833}, {0.166, 0.0833}, {0.125, 0.0625}, {0.063, 0.0312}})
    for (int high = 1; high < 256; ++high)
      for (int low = std::max(0, high - 90); low < high; ++low) {
        const auto code = [](int v) { return static_cast<std::uint8_t>(v); };
        const Rgba8 dark{code(low), code(low), code(low)}, bright{code(high), code(high), code(high)};
        const Rgba8Image image = make_codes(8, 4, [&](int x, int y) { return x > 3 + (y > 1) ? bright : dark; });
        const bool is_seen = high - low >= least * 255 && high - low >= high * share;
        // A step of one code can round to nothing.
        if (high - low > 3) {
          ASSERT_EQ(apply_fxaa(image, {.threshold = share, .least = least}) != image, is_seen) << low << " " << high;
        }
      }
}

TEST(Fxaa, MoreSearchBringsALevelEdgeNearerToItsCoverage) {
  // A half-plane of slope 1/24: the exact area per pixel is the reference, and longer searches come nearer to it.
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
