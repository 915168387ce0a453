// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/tonemap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/display_transform.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr ToneMapping every_curve[] = {ToneMapping::None, ToneMapping::Aces, ToneMapping::Neutral, ToneMapping::Agx,
                                       ToneMapping::Filmic};

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

void expect_near(float3 found, float3 expected, float tolerance) {
  EXPECT_NEAR(found.x, expected.x, tolerance);
  EXPECT_NEAR(found.y, expected.y, tolerance);
  EXPECT_NEAR(found.z, expected.z, tolerance);
}

TEST(Tonemap, NoneClamps) {
  EXPECT_EQ(tone_map({-1, 0.25f, 7}, ToneMapping::None), (float3{0, 0.25f, 1}));
  EXPECT_EQ(tone_map({nan, infinity, -infinity}, ToneMapping::None), (float3{0, 1, 0}));
}

/// Hill's fit for greys: the rows of both matrices sum to 1 within 1e-5, so that only the curve remains.
TEST(Tonemap, AcesOfGreyIsItsCurve) {
  for (const double grey : {0.0, 0.01, 0.18, 0.5, 1.0, 4.0, 30.0}) {
    const double v = grey / 0.6;
    const double curve = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    const auto expected = static_cast<float>(std::clamp(curve, 0.0, 1.0));
    const auto x = static_cast<float>(grey);
    expect_near(tone_map({x, x, x}, ToneMapping::Aces), {expected, expected, expected}, 5e-5f);
  }
}

/// A saturated colour, computed independently in double precision.
TEST(Tonemap, AcesOfRed) {
  const double v[3] = {0.59719 / 0.6, 0.07600 / 0.6, 0.02840 / 0.6};
  double c[3];
  for (int i = 0; i < 3; ++i) {
    c[i] = (v[i] * (v[i] + 0.0245786) - 0.000090537) / (v[i] * (0.983729 * v[i] + 0.4329510) + 0.238081);
  }
  const auto unit = [](double x) { return static_cast<float>(std::clamp(x, 0.0, 1.0)); };
  const float3 expected = {unit(1.60475 * c[0] - 0.53108 * c[1] - 0.07367 * c[2]),
                           unit(-0.10208 * c[0] + 1.10813 * c[1] - 0.00605 * c[2]),
                           unit(-0.00327 * c[0] - 0.07276 * c[1] + 1.07602 * c[2])};
  expect_near(tone_map({1, 0, 0}, ToneMapping::Aces), expected, 1e-6f);
}

TEST(Tonemap, NeutralKeepsBaseColorAndCompressesTheRest) {
  // Below the start of compression a colour only loses the 4 % that a dielectric reflects.
  expect_near(tone_map({0.54f, 0.34f, 0.14f}, ToneMapping::Neutral), {0.5f, 0.3f, 0.1f}, 1e-6f);
  // By hand: least 0.04 gives offset 0.04 - 6.25 0.0016 = 0.03.
  expect_near(tone_map({0.54f, 0.34f, 0.04f}, ToneMapping::Neutral), {0.51f, 0.31f, 0.01f}, 1e-6f);
  // A grey of 1.04: peak 1, new peak 1 - 0.0576 / 0.48 = 0.88; a grey has no hue to desaturate.
  expect_near(tone_map({1.04f, 1.04f, 1.04f}, ToneMapping::Neutral), {0.88f, 0.88f, 0.88f}, 1e-6f);
  // (1.04, 0.54, 0.04 + 0.04): peak 1; white = 1 - 1 / (0.15 0.12 + 1).
  const float white = 1 - 1 / 1.018f;
  const auto mixed = [&](float x) { return x * 0.88f * (1 - white) + 0.88f * white; };
  expect_near(tone_map({1.04f, 0.54f, 0.08f}, ToneMapping::Neutral), {0.88f, mixed(0.5f), mixed(0.04f)}, 1e-6f);
  expect_near(tone_map({1e6f, 1e6f, 1e6f}, ToneMapping::Neutral), {1, 1, 1}, 1e-6f);
}

TEST(Tonemap, NeutralSubtractsTheReflectionOfADielectricFromEveryColourInItsRange) {
  // Wherever all channels are in [0.08, 0.8], "c_out = c_in - F90" (the specification's first note), with its inverse.
  constexpr int steps = 24;
  for (int i = 0; i < (steps + 1) * (steps + 1) * (steps + 1); ++i) {
    const auto channel = [](int k) { return 0.08f + 0.72f * static_cast<float>(k) / steps; };
    const float3 in{channel(i % 25), channel(i / 25 % 25), channel(i / 625)};
    const float3 out = tone_map(in, ToneMapping::Neutral);
    expect_near(out, {in.x - 0.04f, in.y - 0.04f, in.z - 0.04f}, 1e-6f);
    expect_near(invert_neutral(out), in, 1e-5f);
  }
}

TEST(Tonemap, NeutralHasAnInverse) {
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const auto channel = [&](std::uint32_t c) { return unit_float(hash(i, c)) * (i % 2 == 0 ? 1.0f : 3.0f); };
    const float3 color{channel(1), channel(2), channel(3)};
    // Near white the mapped colour in floats determines the colour less exactly.
    const float peak = std::max({color.x, color.y, color.z});
    expect_near(invert_neutral(tone_map(color, ToneMapping::Neutral)), color,
                peak <= 1 ? 1e-5f : 1e-5f * peak * peak * peak);
  }
  expect_near(invert_neutral({0, 0, 0}), {0, 0, 0}, 0);
  EXPECT_TRUE(std::isfinite(invert_neutral({1, 1, 1}).x));
}

using Double3 = std::array<double, 3>;

/// Columns, as in GLSL.
Double3 times(const std::array<Double3, 3>& columns, const Double3& v) {
  Double3 out{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) out[r] += columns[c][r] * v[c];
  return out;
}

/// The published formula, in double. Source: three.js, AgXToneMapping.
Double3 published_agx(Double3 color) {
  color = times({{{0.6274, 0.0691, 0.0164}, {0.3293, 0.9195, 0.0880}, {0.0433, 0.0113, 0.8956}}}, color);
  color = times({{{0.856627153315983, 0.137318972929847, 0.11189821299995},
                  {0.0951212405381588, 0.761241990602591, 0.0767994186031903},
                  {0.0482516061458583, 0.101439036467562, 0.811302368396859}}},
                color);
  for (double& v : color) {
    const double x = std::clamp((std::log2(std::max(v, 1e-10)) + 12.47393) / (4.026069 + 12.47393), 0.0, 1.0);
    v = 15.5 * std::pow(x, 6) - 40.14 * std::pow(x, 5) + 31.96 * std::pow(x, 4) - 6.868 * std::pow(x, 3) +
        0.4298 * x * x + 0.1191 * x - 0.00232;
  }
  color = times({{{1.1271005818144368, -0.1413297634984383, -0.14132976349843826},
                  {-0.11060664309660323, 1.157823702216272, -0.11060664309660294},
                  {-0.016493938717834573, -0.016493938717834257, 1.2519364065950405}}},
                color);
  for (double& v : color) v = std::pow(std::max(0.0, v), 2.2);
  color = times({{{1.6605, -0.1246, -0.0182}, {-0.5876, 1.1329, -0.1006}, {-0.0728, -0.0083, 1.1187}}}, color);
  for (double& v : color) v = std::clamp(v, 0.0, 1.0);
  return color;
}

/// Source: Hable 2010.
double published_filmic(double x) {
  const auto curve = [](double v) {
    return (v * (0.15 * v + 0.1 * 0.5) + 0.2 * 0.02) / (v * (0.15 * v + 0.5) + 0.2 * 0.3) - 0.02 / 0.3;
  };
  return std::clamp(curve(2 * x) / curve(11.2), 0.0, 1.0);
}

TEST(Tonemap, AgxAndFilmicAreThePublishedCurves) {
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const auto channel = [&](std::uint32_t c) { return std::exp2(16 * unit_float(hash(i, c)) - 11); };
    const float3 color{channel(1), channel(2), channel(3)};
    const Double3 agx = published_agx({color.x, color.y, color.z});
    const auto narrow = [](double x) { return static_cast<float>(x); };
    expect_near(tone_map(color, ToneMapping::Agx), {narrow(agx[0]), narrow(agx[1]), narrow(agx[2])}, 1e-5f);
    expect_near(
        tone_map(color, ToneMapping::Filmic),
        {narrow(published_filmic(color.x)), narrow(published_filmic(color.y)), narrow(published_filmic(color.z))},
        2e-6f);
  }
}

TEST(Tonemap, MapsStayInRangeAndRise) {
  for (const ToneMapping mapping : every_curve) {
    float last = 0;
    for (float x = 0.001f; x < 1e6f; x *= 1.05f) {
      const float y = tone_map({x, x, x}, mapping).y;
      EXPECT_GE(y, last - 1e-6f);
      EXPECT_LE(y, 1);
      last = y;
    }
    for (const float odd : {nan, infinity, -infinity, 3e38f, -3e38f, 1e-45f}) {
      const float3 mapped = tone_map({odd, 0.5f, odd}, mapping);
      for (const float x : {mapped.x, mapped.y, mapped.z}) EXPECT_TRUE(x >= 0 && x <= 1) << x;
    }
  }
}

Display shown(Linear color, const DisplayOptions& options) {
  return make_display(LinearImage(1, 1, color), options)(0, 0);
}

TEST(MakeDisplay, OpaqueColorIsExposedMappedAndEncoded) {
  EXPECT_EQ(shown({0.1f, 0.2f, 0.7f, 1}, {}), (Display{encode_srgb(0.1f), encode_srgb(0.2f), encode_srgb(0.7f), 1}));
  EXPECT_EQ(shown({0.1f, 0.2f, 0.7f, 1}, {.exposure = 2}),
            (Display{encode_srgb(0.2f), encode_srgb(0.4f), encode_srgb(1.4f), 1}));
  const float3 mapped = tone_map({0.3f, 2, 5}, ToneMapping::Aces);
  EXPECT_EQ(shown({0.3f, 2, 5, 1}, {.mapping = ToneMapping::Aces}),
            (Display{encode_srgb(mapped.x), encode_srgb(mapped.y), encode_srgb(mapped.z), 1}));
  EXPECT_EQ(shown({0.1f, 0.2f, 1.7f, 1}, {.mapping = ToneMapping::Aces, .exposure = 0.5f, .raw = true}),
            (Display{0.05f, 0.1f, 0.85f, 1}));
}

TEST(MakeDisplay, CodesAreThoseOfTheImageBetween) {
  LinearImage image(131, 77);  // neither rows nor the image are whole blocks
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    const auto value = [&](std::uint32_t channel) {
      return 3 * unit_float(hash(static_cast<std::uint32_t>(i), channel)) - 0.5f;
    };
    image.values()[i] = {value(0), value(1), value(2), value(3)};
  }
  image(0, 0) = {nan, infinity, -infinity, 1}, image(130, 76) = {1, 1, 1, nan};
  for (const ToneMapping mapping : every_curve)
    for (const bool is_transparent : {false, true}) {
      const DisplayOptions options{
          .mapping = mapping, .exposure = 1.3f, .is_transparent = is_transparent, .background = default_background};
      EXPECT_EQ(make_display8(image, options), quantize8(make_display(image, options))) << static_cast<int>(mapping);
    }
}

TEST(MakeDisplay, BackgroundIsShownAsItIs) {
  const float4 background = {0.2f, 0.4f, 0.6f, 1};
  EXPECT_EQ(shown({0, 0, 0, 0}, {.mapping = ToneMapping::Aces, .exposure = 3, .background = background}),
            (Display{0.2f, 0.4f, 0.6f, 1}));
  EXPECT_EQ(shown({0, 0, 0, 0}, {.background = {0.2f, 0.4f, 0.6f, 0.5f}}), (Display{0.2f, 0.4f, 0.6f, 0.5f}));
  EXPECT_EQ(shown({0, 0, 0, 0}, {.background = {0.2f, 0.4f, 0.6f, 0}}), (Display{0, 0, 0, 0}));
}

TEST(MakeDisplay, HalfCoveredPixelsMixLight) {
  // White with half coverage over black, and over white: the mean of the light.
  const Linear half = {0.5f, 0.5f, 0.5f, 0.5f};
  EXPECT_EQ(shown(half, {}), (Display{encode_srgb(0.5f), encode_srgb(0.5f), encode_srgb(0.5f), 1}));
  EXPECT_EQ(shown(half, {.background = {1, 1, 1, 1}}), (Display{1, 1, 1, 1}));
  // Over a background with half coverage: alpha 3/4, of which 2/3 are white.
  const Display over = shown(half, {.background = {0, 0, 0, 0.5f}});
  EXPECT_FLOAT_EQ(over.a, 0.75f);
  EXPECT_NEAR(over.r, encode_srgb(2.0f / 3), 1e-6f);
}

TEST(MakeDisplay, TransparentPicturesKeepStraightColor) {
  const DisplayOptions options = {.is_transparent = true, .background = {1, 0, 0, 1}};
  EXPECT_EQ(shown({0.25f, 0.125f, 0, 0.5f}, options), (Display{encode_srgb(0.5f), encode_srgb(0.25f), 0, 0.5f}));
  EXPECT_EQ(shown({3, 2, 1, 0}, options), (Display{0, 0, 0, 0}));
}

/// Pixels of all kinds: opaque, partially covered, empty, over-bright and not finite.
std::vector<float> pixels(std::uint32_t n, std::uint32_t seed) {
  std::vector<float> values(4 * std::size_t{n});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t sort = hash(i, seed, 9) % 8;
    const float alpha = sort < 3 || seed % 3 == 0 ? 1.0f : sort == 3 ? 0.0f : unit_float(hash(i, seed, 3));
    for (std::uint32_t c = 0; c < 3; ++c) {
      const float odd[] = {nan, infinity, -infinity, -2.0f, 3e38f, 1e-42f, 0.0f, -0.0f};
      const float light = unit_float(hash(i, seed, c)) * (sort % 2 == 0 ? 1.0f : 40.0f) * alpha;
      values[4 * i + c] = sort == 7 ? odd[hash(i, seed, c + 4) % 8] : light;
    }
    values[4 * i + 3] = sort == 7 && hash(i, seed, 8) % 2 == 0 ? nan : alpha;
  }
  return values;
}

TEST(MakeDisplay, EveryInstructionSetGivesTheSameBits) {
  std::vector<DisplayStep> steps;
  for (const ToneMapping mapping : every_curve) {
    for (const bool is_transparent : {false, true}) {
      for (const float alpha : {0.0f, 0.3f, 1.0f}) {
        DisplayStep step = {.mapping = mapping, .exposure = 1.3f, .is_transparent = is_transparent};
        step.is_encoded = alpha != 0.3f;
        const float background[4] = {0.1f, 0.2f, 0.3f, 1};
        for (int c = 0; c < 4; ++c) step.code[c] = step.light[c] = alpha * background[c];
        steps.push_back(step);
      }
    }
  }
  for (const Isa isa : supported_isas()) {
    const TonemapKernels& kernels = TonemapKernels::of(isa);
    for (std::uint32_t n = 0; n <= 200; ++n) {
      const std::vector<float> in = pixels(n, n);
      const DisplayStep& step = steps[n % steps.size()];
      std::vector<float> expected(in.size() + 1, 9), found(in.size() + 1, 9);
      TonemapKernels::scalar.display_row(step, in.data(), expected.data(), n);
      kernels.display_row(step, in.data(), found.data(), n);
      EXPECT_EQ(found, expected) << name_of(isa) << ' ' << n;
      EXPECT_TRUE(std::all_of(found.begin(), found.end() - 1, [](float x) { return x >= 0 && x <= 1; }));
    }
  }
}

TEST(MakeDisplay, DoesNotDependOnThreads) {
  const std::vector<float> values = pixels(211 * 97, 5);
  LinearImage image(211, 97);
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    image.values()[i] = {values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]};
  }
  DisplayImage one, seven;
  const DisplayOptions options = {.mapping = ToneMapping::Neutral, .background = {0.5f, 0.5f, 0.5f, 1}};
  with_threads(1, [&] { one = make_display(image, options); });
  with_threads(7, [&] { seven = make_display(image, options); });
  EXPECT_EQ(one, seven);
  EXPECT_TRUE(make_display(LinearImage(), options).empty());
}

TEST(DisplayTransform, ShowsWhatMakeDisplayDoesQuantized) {
  // Three opaque groups of eight pixels, of which two are displayed together, and three mixed ones.
  LinearImage image(48, 1);
  for (int x = 0; x < 48; ++x) {
    const float a = x < 24 ? 1.0f : x % 5 == 0 ? 0.0f : static_cast<float>(x) / 47;
    const auto light = [&](float f) { return a * (x % 7 == 0 ? -1.0f : f * static_cast<float>(x * x) / 700); };
    image(x, 0) = {light(1), light(0.7f), x == 3 ? std::numeric_limits<float>::quiet_NaN() : light(2.5f), a};
  }
  Linear8 groups[6];
  for (std::size_t i = 0; i < 48; ++i) groups[i / 8].set(i % 8, image(static_cast<int>(i), 0));
  for (const ToneMapping mapping : every_curve)
    for (int bits = 0; bits < 4; ++bits) {
      const DisplayOptions options{.mapping = mapping,
                                   .exposure = 1.3f,
                                   .is_transparent = (bits & 1) != 0,
                                   .background = {0.2f, 0.4f, 0.6f, 0.7f},
                                   .raw = (bits & 2) != 0};
      Rgba8 shown[48];
      const Rgba8Image expected = quantize8(make_display(image, options));
      // The same pixels as spans that are stored apart from each other.
      alignas(64) float channel[4][48];
      for (std::size_t i = 0; i < 48; ++i) {
        const Linear c = image(static_cast<int>(i), 0);
        channel[0][i] = c.r, channel[1][i] = c.g, channel[2][i] = c.b, channel[3][i] = c.a;
      }
      Rgba8 spans[6][11];
      Rgba8* const place[6] = {spans[4], spans[0] + 3, spans[2], spans[5], spans[1] + 1, spans[3]};
      for (const Isa isa : supported_isas()) {
        with_isa(isa, [&] { DisplayTransform(options).present(groups, shown); });
        for (int x = 0; x < 48; ++x) EXPECT_EQ(shown[x], expected(x, 0)) << x << " " << bits << name_of(isa);
        for (auto& span : spans) std::fill(std::begin(span), std::end(span), Rgba8{});
        with_isa(isa, [&] {
          DisplayTransform(options).present({{channel[0], channel[1], channel[2], channel[3]}, 8}, place);
        });
        for (int x = 0; x < 48; ++x) EXPECT_EQ(place[x / 8][x % 8], expected(x, 0)) << x << " " << bits << name_of(isa);
      }
    }
}

TEST(DisplayTransform, IsDecidedOnlyIfNothingBehindChangesACode) {
  constexpr float brightest = 3;
  int decided = 0;
  for (std::uint32_t i = 0; i < 6000; ++i) {
    const auto random = [&](std::uint32_t k) { return unit_float(hash(i, k)); };
    const DisplayOptions options{
        .exposure = i % 3 == 0 ? 1.0f : 0.5f + random(0), .background = {0.2f, 0.9f, 1, 1}, .raw = i % 2 == 0};
    const DisplayTransform transform(options);
    Linear8 front, behind;
    for (std::uint32_t k = 0; k < 8; ++k)
      front.set(k, {random(3 * k + 1), 0.01f * random(3 * k + 2), 1.5f * random(3 * k + 3),
                    std::ldexp(random(k + 40), -12 - static_cast<int>(i % 10))});
    for (const Isa isa : supported_isas())
      with_isa(isa, [&] {
        ASSERT_EQ(transform.is_decided(front, brightest, 0x1p-22f),
                  with_isa(Isa::Scalar, [&] { return transform.is_decided(front, brightest, 0x1p-22f); }));
      });
    if (!transform.is_decided(front, brightest, 0x1p-22f)) continue;
    ++decided;
    Rgba8 first[8], shown[8];
    for (std::uint32_t way = 0; way < 6; ++way) {
      for (std::uint32_t k = 0; k < 8; ++k) {
        const Linear f = front.get(k);
        const float a = way < 2 ? 0.0f : way < 4 ? 1.0f : random(way * 8 + k), light = way % 2 == 0 ? 0 : a * brightest;
        behind.set(k, {f.r + f.a * light, f.g + f.a * light, f.b + f.a * light, 1 - (1 - a) * f.a});
      }
      transform.present({&behind, 1}, way == 0 ? first : shown);
      for (std::size_t k = 0; k < 8 && way > 0; ++k) ASSERT_EQ(shown[k], first[k]) << i << " " << way;
    }
  }
  EXPECT_GT(decided, 1500);
  const Linear8 nothing{};
  EXPECT_TRUE(DisplayTransform({.background = {0, 0, 0, 1}}).is_decided(nothing, 1, 0));
  EXPECT_FALSE(DisplayTransform({.mapping = ToneMapping::Aces, .background = {0, 0, 0, 1}}).is_decided(nothing, 1, 0));
  EXPECT_FALSE(DisplayTransform({.background = {0, 0, 0, 0.5f}}).is_decided(nothing, 1, 0));
  EXPECT_FALSE(DisplayTransform({.is_transparent = true}).is_decided(nothing, 1, 0));
}

}  // namespace
}  // namespace zoneplate
