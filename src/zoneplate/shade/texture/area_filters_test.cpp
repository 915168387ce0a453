// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/area_filters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/texture/noise_for_test.h"
#include "zoneplate/shade/texture/sample.h"
#include "zoneplate/shade/texture/texture.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

using Kind = TextureFilter::Kind;

constexpr Kind area_kinds[] = {Kind::CatmullRom, Kind::BSpline, Kind::Mitchell,  Kind::Ripmap,
                               Kind::Ewa,        Kind::Sat,     Kind::Stochastic};

float area_random(std::uint32_t i, std::uint32_t dimension) { return unit_float(hash(i, dimension, 77)); }

/// Fragments whose coordinates and footprints differ; some are not finite.
struct AreaPoints {
  static constexpr int count = 64;
  alignas(64) float value[9][Taps::padded_capacity] = {};
  AreaPoints() {
    for (std::uint32_t i = 0; i < count; ++i) {
      value[0][i] = 6 * area_random(i, 0) - 3, value[1][i] = 6 * area_random(i, 1) - 3;
      for (std::uint32_t d = 2; d < 6; ++d)
        value[d][i] = (2 * area_random(i, d) - 1) * std::exp2(-9 * area_random(i, 9) + (d < 4 ? 1.0f : -2.0f));
      for (std::uint32_t d = 6; d < 9; ++d) value[d][i] = area_random(i, d);
    }
    constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    value[0][40] = infinity, value[1][41] = nan, value[0][42] = -1e30f;
    value[2][43] = infinity, value[3][44] = nan, value[4][45] = 1e30f;
    for (int d = 2; d < 6; ++d) value[d][46] = 0;
  }
  Footprint footprint() const {
    return {value[0], value[1], value[2], value[3], value[4], value[5], nullptr, {value[6], value[7], value[8]}};
  }
};

struct AreaValues {
  alignas(64) float channel[4][Taps::padded_capacity] = {};
};

AreaValues look(const Texture& texture, const SamplerState& state, const Footprint& footprint, int count, Isa isa) {
  AreaValues values;
  float* const out[4] = {values.channel[0], values.channel[1], values.channel[2], values.channel[3]};
  with_isa(isa, [&] { sample_area(texture, state, footprint, out, count); });
  return values;
}

SamplerState state_of(Kind kind, Wrap u = Wrap::Repeat, Wrap v = Wrap::Repeat, int anisotropy = 16) {
  return make_filtering({.wrap_u = u, .wrap_v = v}, 1, {kind, anisotropy});
}

Plane<float4> exact_half_noise(int width, int height) {
  Plane<float4> image(width, height);
  for (std::uint32_t i = 0; i < image.values().size(); ++i) {
    const auto value = [&](std::uint32_t c) { return static_cast<float>(hash(i, c, 5) % 2048) * 0x1p-8f; };
    image.values()[i] = {value(0), value(1), value(2), 1};
  }
  return image;
}

TEST(AreaFilters, EveryInstructionSetGivesTheSameBits) {
  const Texture textures[] = {
      Texture(noise(64, 32, 3), TexelMeaning::Color), Texture(noise(19, 44, 3), TexelMeaning::Values),
      Texture(bright_noise(19, 44), TexelMeaning::Color), Texture(exact_half_noise(32, 16), TexelMeaning::Color),
      Texture(noise(1, 1, 3), TexelMeaning::Color)};
  constexpr Wrap wraps[] = {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp};
  const AreaPoints points;
  for (const Texture& texture : textures)
    for (const Kind kind : area_kinds)
      for (int w = 0; w < 3; ++w) {
        const SamplerState state = state_of(kind, wraps[w], wraps[(w + 1) % 3], 4);
        const AreaValues expected = look(texture, state, points.footprint(), AreaPoints::count, Isa::Scalar);
        for (const Isa isa : supported_isas()) {
          const AreaValues values = look(texture, state, points.footprint(), AreaPoints::count, isa);
          for (int c = 0; c < 4; ++c)
            ASSERT_EQ(std::memcmp(values.channel[c], expected.channel[c], AreaPoints::count * sizeof(float)), 0)
                << name_of(isa) << " filter " << static_cast<int>(kind) << " wrap " << w;
        }
        for (int c = 0; c < 4; ++c)
          for (int i = 0; i < AreaPoints::count; ++i) ASSERT_TRUE(std::isfinite(expected.channel[c][i]));
      }
}

TEST(AreaFilters, GroupsThatRepeatTheirFootprintHaveIt) {
  const Texture texture(noise(64, 32, 3), TexelMeaning::Color);
  AreaPoints points;
  for (int d = 2; d < 6; ++d)
    for (int i = 8; i < 16; ++i) points.value[d][i] = points.value[d][7];
  const bool repeats[Taps::groups] = {false, true};
  for (const Kind kind : area_kinds) {
    const AreaValues expected = look(texture, state_of(kind), points.footprint(), 16, best_isa());
    AreaPoints holes = points;
    for (int d = 2; d < 6; ++d)
      for (int i = 8; i < 16; ++i) holes.value[d][i] = 1e9f;
    Footprint footprint = holes.footprint();
    footprint.repeats = repeats;
    const AreaValues values = look(texture, state_of(kind), footprint, 16, best_isa());
    for (int c = 0; c < 4; ++c)
      ASSERT_EQ(std::memcmp(values.channel[c], expected.channel[c], 16 * sizeof(float)), 0) << static_cast<int>(kind);
  }
}

TEST(AreaFilters, ConstantTexturesStayConstantToTheBit) {
  const AreaPoints points;
  for (const int code : {0, 1, 77, 200, 255}) {
    const auto byte = static_cast<std::uint8_t>(code);
    Rgba8Image codes(37, 20, Rgba8{byte, 9, 130, 251});
    Plane<float4> light(21, 16, float4{0.1f + static_cast<float>(code), 1e-5f, 3e8f, 0.3f});
    const Texture textures[] = {Texture(codes, TexelMeaning::Values), Texture(codes, TexelMeaning::Color),
                                Texture(light, TexelMeaning::Color)};
    for (const Texture& texture : textures) {
      const float4 expected =
          sample(texture, {.magnify = TexelFilter::Nearest, .level = LevelFilter::None}, {0.5f, 0.5f}, {}, {});
      for (const Kind kind : area_kinds)
        for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp}) {
          const AreaValues values =
              look(texture, state_of(kind, wrap, wrap), points.footprint(), AreaPoints::count, best_isa());
          for (int i = 0; i < AreaPoints::count; ++i) {
            ASSERT_EQ(values.channel[0][i], expected.x) << static_cast<int>(kind) << " " << code << " " << i;
            ASSERT_EQ(values.channel[1][i], expected.y);
            ASSERT_EQ(values.channel[2][i], expected.z);
            ASSERT_EQ(values.channel[3][i], expected.w);
          }
        }
    }
  }
}

float4 look(const Texture& texture, Kind kind, float2 uv, float2 dx, float2 dy, float3 numbers = {}) {
  return sample(texture, {}, {kind, 16}, uv, dx, dy, numbers);
}

TEST(Cubic, InterpolatesAndReproducesRamps) {
  const Rgba8Image image = noise(16, 8, 3);
  const Texture texture(image, TexelMeaning::Values);
  Rgba8Image ramp(64, 1);
  for (int x = 0; x < 64; ++x) ramp(x, 0) = {static_cast<std::uint8_t>(4 * x), 0, 0, 255};
  const Texture slope(ramp, TexelMeaning::Values);
  const float2 dx{1.0f / 128, 0}, dy{0, 1.0f / 128};
  for (int x = 0; x < 16; ++x) {
    const float2 uv{(static_cast<float>(x) + 0.5f) / 16, 3.5f / 8};
    EXPECT_NEAR(look(texture, Kind::CatmullRom, uv, dx, dy).x, static_cast<float>(image(x, 3).r) / 255, 1e-6);
    // B-spline: 1/6, 2/3, 1/6 along each axis.
    double sum = 0;
    for (int j = -1; j <= 1; ++j)
      for (int i = -1; i <= 1; ++i)
        sum += (i == 0 ? 4.0 : 1.0) * (j == 0 ? 4.0 : 1.0) / 36 * image((x + i + 16) % 16, 3 + j).r / 255;
    EXPECT_NEAR(look(texture, Kind::BSpline, uv, dx, dy).x, sum, 1e-6);
  }
  for (const Kind kind : {Kind::CatmullRom, Kind::BSpline, Kind::Mitchell})
    for (const float place : {10.25f, 20.5f, 31.9f})
      EXPECT_NEAR(look(slope, kind, {(place + 0.5f) / 64, 0.5f}, dx, dy).x, 4 * place / 255, 2e-6);
}

TEST(Ripmap, ReducesEachAxisByItsOwnExtent) {
  const Rgba8Image image = noise(32, 16, 3);
  const Texture texture(image, TexelMeaning::Values);
  const RipmapView& r = texture.ripmap();
  EXPECT_EQ(r.columns, 6);
  EXPECT_EQ(r.rows, 5);
  // Eight texels along u, one along v: the mean of a row's aligned eight.
  const float4 along_u = look(texture, Kind::Ripmap, {12.0f / 32, 5.5f / 16}, {8.0f / 32, 0}, {0, 1.0f / 16});
  // Four along v, one along u.
  const float4 along_v = look(texture, Kind::Ripmap, {9.5f / 32, 6.0f / 16}, {1.0f / 32, 0}, {0, 4.0f / 16});
  double u = 0, v = 0;
  for (int i = 0; i < 8; ++i) u += image(8 + i, 5).g / 255.0 / 8;
  for (int i = 0; i < 4; ++i) v += image(9, 4 + i).g / 255.0 / 4;
  EXPECT_NEAR(along_u.y, u, 2.0 / 255);  // three roundings to unorm8
  EXPECT_NEAR(along_v.y, v, 2.0 / 255);
}

/// The integral of the image, repeated or mirrored or clamped, over a box in texels, by small steps.
double box_mean(const Rgba8Image& image, double x0, double x1, double y0, double y1, bool mirrors) {
  constexpr int steps = 256;
  const auto wrapped = [&](double x, int n) {
    const int i = static_cast<int>(std::floor(x)), period = mirrors ? 2 * n : n, j = ((i % period) + period) % period;
    return j < n ? j : period - 1 - j;
  };
  double sum = 0;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i)
      sum += image(wrapped(x0 + (x1 - x0) * (i + 0.5) / steps, image.width()),
                   wrapped(y0 + (y1 - y0) * (j + 0.5) / steps, image.height()))
                 .b;
  return sum / (255.0 * steps * steps);
}

TEST(Sums, AreTheMeanOverTheBoundingBox) {
  const Rgba8Image image = noise(16, 16, 3);
  const Texture texture(image, TexelMeaning::Values);
  for (std::uint32_t n = 0; n < 24; ++n) {
    const float u = 4 * area_random(n, 0) - 2, v = 4 * area_random(n, 1) - 2, w = 0.4f * area_random(n, 2),
                h = 0.4f * area_random(n, 3);
    for (const bool mirrors : {false, true}) {
      const Wrap wrap = mirrors ? Wrap::Mirror : Wrap::Repeat;
      const float4 value =
          sample(texture, {.wrap_u = wrap, .wrap_v = wrap}, {Kind::Sat, 1}, {u, v}, {w, h / 2}, {-w / 3, h / 2});
      const double a = 16.0 * std::max(w * 4 / 3, 1.0f / 16) / 2, b = 16.0 * std::max(h, 1.0f / 16) / 2;
      EXPECT_NEAR(value.z, box_mean(image, 16 * u - a, 16 * u + a, 16 * v - b, 16 * v + b, mirrors), 0.012) << n;
    }
  }
}

/// EWA by its definition, over level 0 without mip levels, in double.
double ellipse_mean(const Rgba8Image& image, float2 uv, float2 dx, float2 dy) {
  const int n = image.width();
  const auto texels = [n](float v) { return static_cast<double>(v) * n; };
  const double ux = texels(dx.x), vx = texels(dx.y), uy = texels(dy.x), vy = texels(dy.y), det = ux * vy - uy * vx;
  double sum = 0, total = 0;
  for (int y = -2 * n; y < 3 * n; ++y)
    for (int x = -2 * n; x < 3 * n; ++x) {
      const double s = x + 0.5 - texels(uv.x), t = y + 0.5 - texels(uv.y);
      const double px = (s * vy - t * uy) / det, py = (t * ux - s * vx) / det, r2 = px * px + py * py;
      const double weight = r2 < 1 ? std::exp(-2 * r2) - std::exp(-2.0) : 0;
      sum += weight * image(((x % n) + n) % n, ((y % n) + n) % n).r / 255.0, total += weight;
    }
  return sum / total;
}

TEST(Ewa, AgreesWithItsOwnGaussianOverLevelZero) {
  const Rgba8Image image = noise(128, 128, 3);
  const Texture texture(image, TexelMeaning::Values);
  double fine = 0, coarse = 0, trilinear = 0;
  constexpr int count = 60;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float angle = 6.28f * area_random(i, 0), turn = 6.28f * area_random(i, 1), ratio = 1 + 10 * area_random(i, 2);
    const float2 uv{area_random(i, 3), area_random(i, 4)};
    const auto footprints = [&](float shorter) {
      const float l = shorter * ratio / 128, s = shorter / 128, c = std::cos(angle), d = std::sin(angle);
      const float e = std::cos(turn), f = std::sin(turn);
      const float2 dx{c * l * e - d * s * f, d * l * e + c * s * f}, dy{-c * l * f - d * s * e, -d * l * f + c * s * e};
      return std::pair{dx, dy};
    };
    // Below two texels, level 0 alone is read, and the definition is met to rounding.
    const auto [fx, fy] = footprints(1.5f);
    fine = std::max(
        fine, std::abs(static_cast<double>(look(texture, Kind::Ewa, uv, fx, fy).x) - ellipse_mean(image, uv, fx, fy)));
    const auto [cx, cy] = footprints(2.0f + 4 * area_random(i, 5));
    const double reference = ellipse_mean(image, uv, cx, cy);
    coarse += std::pow(static_cast<double>(look(texture, Kind::Ewa, uv, cx, cy).x) - reference, 2);
    trilinear += std::pow(static_cast<double>(sample(texture, {}, uv, cx, cy).x) - reference, 2);
  }
  EXPECT_LT(fine, 2e-5);
  EXPECT_LT(std::sqrt(coarse / count), 0.006);  // of white noise with a deviation of 0.29
  EXPECT_GT(trilinear, 4 * coarse);
}

TEST(Ewa, FollowsTheFootprintInAMirroredImage) {
  const Rgba8Image image = noise(64, 64, 3);
  const Texture texture(image, TexelMeaning::Values);
  const Sampler mirrored{.wrap_u = Wrap::Mirror, .wrap_v = Wrap::Repeat};
  const auto at = [&](float u, float slope) {
    return sample(texture, mirrored, {Kind::Ewa, 16}, {u, 0.4f}, {0.1f, slope}, {-0.1f * slope, 0.02f}).x;
  };
  EXPECT_NEAR(at(0.3f, 0.08f), at(-0.3f, -0.08f), 1e-5);
  EXPECT_NEAR(at(0.3f, 0.08f), at(2.3f, 0.08f), 1e-5);
  EXPECT_GT(std::abs(at(0.3f, 0.08f) - at(-0.3f, 0.08f)), 1e-3);
}

TEST(Stochastic, AveragesToTrilinear) {
  const Rgba8Image image = noise(16, 16, 3);
  const Texture texture(image, TexelMeaning::Values);
  const float2 uv{0.33f, 0.71f}, dx{2.7f / 16, 0}, dy{0, 2.1f / 16};
  const float4 expected = sample(texture, {}, uv, dx, dy);
  constexpr std::uint32_t count = 40'000;
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float value =
        look(texture, Kind::Stochastic, uv, dx, dy, {area_random(i, 0), area_random(i, 1), area_random(i, 2)}).x;
    EXPECT_NEAR(value * 255, std::round(value * 255), 1e-4);  // one texel
    sum += static_cast<double>(value);
  }
  EXPECT_NEAR(sum / count, expected.x, 0.003);
}

TEST(Footprints, HaveTheLevelOfTheAnalyticFootprint) {
  const Texture texture(Rgba8Image(256, 64), TexelMeaning::Values);
  alignas(64) float u[16] = {}, ux[16], vx[16], uy[16], vy[16], level[16], ratio[16];
  for (int i = 0; i < 16; ++i) {
    const float size = std::exp2(static_cast<float>(i) / 2 - 3);  // texels a pixel
    ux[i] = size / 256, vx[i] = 0, uy[i] = 0, vy[i] = size / 64 / 4;
  }
  measure_footprints(texture.view(), {u, u, ux, vx, uy, vy}, level, ratio, 16);
  for (int i = 0; i < 16; ++i) {
    EXPECT_NEAR(level[i], static_cast<float>(i) / 2 - 3, 2e-3) << i;
    EXPECT_NEAR(ratio[i], 4, 1e-4);
  }
}

}  // namespace
}  // namespace zoneplate
