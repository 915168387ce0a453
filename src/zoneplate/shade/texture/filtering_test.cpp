// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/filtering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/image/half.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/shade/texture/noise_for_test.h"
#include "zoneplate/shade/texture/texture.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

constexpr int capacity = Taps::capacity;

const FilteringKernels& kernels(Isa isa) { return FilteringKernels::of(isa); }

/// Places to look at, all with one footprint unless said otherwise.
struct Points {
  alignas(64) float u[capacity] = {}, v[capacity] = {};
  alignas(64) float dudx[capacity] = {}, dvdx[capacity] = {}, dudy[capacity] = {}, dvdy[capacity] = {};
  int count = 0;

  void add(float u_in, float v_in, float width = 0) {
    u[count] = u_in, v[count] = v_in;
    dudx[count++] = width;
  }
  int padded() const { return (count + 7) / 8 * 8; }
  Footprint footprint() const { return {u, v, dudx, dvdx, dudy, dvdy}; }
};

struct Values {
  alignas(64) float channel[4][capacity] = {};
};

Values look_up(const Texture& texture, const SamplerState& filtering, const Points& points, Isa isa = best_isa()) {
  static Taps taps;
  Values values;
  float* const out[4] = {values.channel[0], values.channel[1], values.channel[2], values.channel[3]};
  kernels(isa).compute_taps(texture.view(), filtering, points.footprint(), taps, points.padded());
  kernels(isa).mix_taps(texture.view(), taps, out, points.padded());
  return values;
}

Values look_along(const Texture& texture, const SamplerState& filtering, const Points& points, Isa isa = best_isa()) {
  Values values;
  float* const out[4] = {values.channel[0], values.channel[1], values.channel[2], values.channel[3]};
  kernels(isa).sample_anisotropic(texture.view(), filtering, points.footprint(), out, points.padded());
  return values;
}

TEST(SamplerState, BilinearAtATexelsCentreIsThatTexel) {
  const Rgba8Image image = noise(16, 8, 3);
  const Texture texture(image, TexelMeaning::Values);
  for (int y = 0; y < 8; ++y) {
    Points points;
    for (int x = 0; x < 16; ++x) points.add((static_cast<float>(x) + 0.5f) / 16, (static_cast<float>(y) + 0.5f) / 8);
    const Values values = look_up(texture, {}, points);
    for (int x = 0; x < 16; ++x) {
      EXPECT_EQ(values.channel[0][x], static_cast<float>(image(x, y).r) * (1.0f / 255));
      EXPECT_EQ(values.channel[3][x], static_cast<float>(image(x, y).a) * (1.0f / 255));
    }
  }
}

TEST(SamplerState, ZeroAndOneAreExact) {
  Rgba8Image image(2, 1);
  image(0, 0) = {0, 255, 0, 255};
  image(1, 0) = {0, 255, 255, 0};
  for (const TexelMeaning meaning : {TexelMeaning::Values, TexelMeaning::Color}) {
    Points points;
    points.add(0.25f, 0.5f), points.add(0.5f, 0.5f);
    const Values values = look_up(Texture(image, meaning), {}, points);
    EXPECT_EQ(values.channel[0][0], 0.0f);
    EXPECT_EQ(values.channel[1][0], 1.0f);
    EXPECT_EQ(values.channel[1][1], 1.0f);
    EXPECT_NEAR(values.channel[2][1], 0.5f, meaning == TexelMeaning::Values ? 0 : 1.0f / 32767);
  }
}

/// The texel at an integer place, by the definition of each wrap mode.
int wrapped(int i, int n, Wrap mode) {
  if (mode == Wrap::Clamp) return std::min(std::max(i, 0), n - 1);
  const int period = mode == Wrap::Repeat ? n : 2 * n;
  const int j = ((i % period) + period) % period;
  return j < n ? j : period - 1 - j;
}

/// Bilinear by the definition, in double.
double bilinear(const Rgba8Image& image, double u, double v, Wrap wrap_u, Wrap wrap_v) {
  const double x = u * image.width() - 0.5, y = v * image.height() - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  const auto texel = [&](double i, double j) {
    return image(wrapped(static_cast<int>(i), image.width(), wrap_u),
                 wrapped(static_cast<int>(j), image.height(), wrap_v))
               .g /
           255.0;
  };
  return (texel(x0, y0) * (1 - fx) + texel(x0 + 1, y0) * fx) * (1 - fy) +
         (texel(x0, y0 + 1) * (1 - fx) + texel(x0 + 1, y0 + 1) * fx) * fy;
}

TEST(SamplerState, EveryWrapModeAgreesWithItsDefinition) {
  constexpr Wrap modes[] = {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp};
  const int sizes[][2] = {{8, 4}, {5, 3}, {1, 7}};
  for (const auto& size : sizes) {
    const Rgba8Image image = noise(size[0], size[1], 3);
    const Texture texture(image, TexelMeaning::Values);
    for (const Wrap wrap_u : modes)
      for (const Wrap wrap_v : modes) {
        // Multiples of 1/64 are exact for the 8 × 4 image, and its weights too; three mixes round half a unit each.
        const double tolerance = size[0] == 8 ? 1.6 / 32640 : 2.5 / 32640;
        Points points;
        for (int i = 0; i < 128; ++i) {
          const std::uint32_t word = hash(static_cast<std::uint32_t>(i), 11);
          points.add(static_cast<float>(static_cast<int>(word % 448) - 192) / 64,
                     static_cast<float>(static_cast<int>(word / 448 % 448) - 192) / 64);
        }
        const Values values = look_up(texture, make_filtering({.wrap_u = wrap_u, .wrap_v = wrap_v}), points);
        for (int i = 0; i < points.count; ++i)
          ASSERT_NEAR(values.channel[1][i], bilinear(image, points.u[i], points.v[i], wrap_u, wrap_v), tolerance)
              << points.u[i] << " " << points.v[i];
      }
  }
}

TEST(SamplerState, NearestTakesTheTexelThatHoldsThePoint) {
  const Rgba8Image image = noise(8, 4, 3);
  const Texture texture(image, TexelMeaning::Values);
  for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp}) {
    const Sampler sampler{
        .wrap_u = wrap, .wrap_v = wrap, .magnify = TexelFilter::Nearest, .minify = TexelFilter::Nearest};
    Points points;
    for (int i = 0; i < 128; ++i) {
      const std::uint32_t word = hash(static_cast<std::uint32_t>(i), 12);
      points.add(static_cast<float>(2 * static_cast<int>(word % 224) - 191) / 128,
                 static_cast<float>(2 * static_cast<int>(word / 224 % 224) - 191) / 128);
    }
    const Values values = look_up(texture, make_filtering(sampler), points);
    for (int i = 0; i < points.count; ++i) {
      const int x = wrapped(static_cast<int>(std::floor(points.u[i] * 8)), 8, wrap);
      const int y = wrapped(static_cast<int>(std::floor(points.v[i] * 4)), 4, wrap);
      ASSERT_EQ(values.channel[2][i], static_cast<float>(image(x, y).b) * (1.0f / 255));
    }
  }
}

/// The same noise in half floats.
Plane<float4> half_noise(int width, int height) {
  Plane<float4> image = bright_noise(width, height);
  for (float4& p : image.values())
    for (float* const v : {&p.x, &p.y, &p.z, &p.w}) *v = half_value(half_bits(*v));
  return image;
}

/// A level of a texture of floats by the definition of bilinear filtering, in double.
double bilinear(const TextureView& view, int level, int channel, double u, double v, Wrap wrap_u, Wrap wrap_v) {
  const int w = view.width[level], h = view.height[level];
  const double x = u * w - 0.5, y = v * h - 0.5, x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  const auto texel = [&](double i, double j) -> double {
    const std::int32_t at =
        view.texel(level, wrapped(static_cast<int>(i), w, wrap_u), wrapped(static_cast<int>(j), h, wrap_v));
    return view.values[std::ptrdiff_t{4} * at + channel];
  };
  return (texel(x0, y0) * (1 - fx) + texel(x0 + 1, y0) * fx) * (1 - fy) +
         (texel(x0, y0 + 1) * (1 - fx) + texel(x0 + 1, y0 + 1) * fx) * fy;
}

TEST(SamplerState, TrilinearOfFloatsAgreesWithItsDefinition) {
  const Texture texture(bright_noise(16, 8), TexelMeaning::Color);
  const TextureView& view = texture.view();
  for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp}) {
    // Places and weights that 15 bits hold, and the level 1 + 1/2 and a bit, by a footprint of 2 √2 texels.
    Points points;
    for (std::uint32_t i = 0; i < 128; ++i) {
      const std::uint32_t word = hash(i, 11);
      points.add(static_cast<float>(static_cast<int>(word % 448) - 192) / 64,
                 static_cast<float>(static_cast<int>(word / 448 % 448) - 192) / 64, i % 2 == 0 ? 0.0f : 2.828427f / 16);
    }
    const SamplerState filtering = make_filtering({.wrap_u = wrap, .wrap_v = wrap});
    static Taps taps;
    kernels(best_isa()).compute_taps(view, filtering, points.footprint(), taps, points.padded());
    const Values values = look_up(texture, filtering, points);
    for (int i = 0; i < points.count; ++i) {
      const double mip_weight = taps.mip_weight[Taps::by_fours(i)] / 32768.0;
      EXPECT_NEAR(mip_weight, i % 2 == 0 ? 0 : 0.5, 1e-3);
      for (int c = 0; c < 4; ++c) {
        const auto at = [&](int level) { return bilinear(view, level, c, points.u[i], points.v[i], wrap, wrap); };
        const double expected = i % 2 == 0 ? at(0) : at(1) * (1 - mip_weight) + at(2) * mip_weight;
        // Three mixes, each rounded three times, of values up to the greatest of the eight.
        ASSERT_NEAR(values.channel[c][i], expected, 9 * 0x1p-24 * (c == 3 ? 1 : 65536)) << i << " " << c;
      }
    }
  }
}

TEST(SamplerState, ATexelOfGreatLightIsExact) {
  Plane<float4> image(4, 4, float4{0.25f, 0, 1, 1});
  image(2, 1) = {1e4f, 1e9f, 3e5f, 0.5f};
  const Texture texture(image, TexelMeaning::Color);
  Points points;
  points.add(0.625f, 0.375f);
  for (const Isa isa : supported_isas()) {
    const Values values = look_up(texture, {}, points, isa);
    EXPECT_EQ(values.channel[0][0], 1e4f);
    EXPECT_EQ(values.channel[1][0], 1e9f);
    EXPECT_EQ(values.channel[2][0], 3e5f);
    EXPECT_EQ(values.channel[3][0], 0.5f);
  }
}

TEST(SamplerState, SixteenBitsGiveMoreThan256Levels) {
  Rgba16Image ramp(1024, 1);
  for (int i = 0; i < 1024; ++i) ramp(i, 0).r = static_cast<std::uint16_t>(20000 + i);
  const Texture texture(ramp, TexelMeaning::Values);
  for (int first = 0; first < 1024; first += 128) {
    Points points;
    for (int i = 0; i < 128; ++i) points.add((static_cast<float>(first + i) + 0.5f) / 1024, 0.5f);
    const Values values = look_up(texture, {}, points);
    for (int i = 0; i < 128; ++i) ASSERT_EQ(values.channel[0][i], static_cast<float>((20000 + first + i) / 65535.0));
  }
}

/// Bilinear filtering of half an image's size, which is even, by definition in double: level 1 without its rounding.
double bilinear_of_means(const Plane<float4>& image, int channel, double u, double v, Wrap wrap_u, Wrap wrap_v) {
  const auto component = [&](int x, int y) -> double {
    const float4& p = image(x, y);
    return channel == 0 ? p.x : channel == 1 ? p.y : channel == 2 ? p.z : p.w;
  };
  const int w = image.width() / 2, h = image.height() / 2;
  const double x = u * w - 0.5, y = v * h - 0.5, x0 = std::floor(x), y0 = std::floor(y), fx = x - x0, fy = y - y0;
  const auto texel = [&](double i, double j) {
    const int s = 2 * wrapped(static_cast<int>(i), w, wrap_u), t = 2 * wrapped(static_cast<int>(j), h, wrap_v);
    return (component(s, t) + component(s + 1, t) + component(s, t + 1) + component(s + 1, t + 1)) / 4;
  };
  return (texel(x0, y0) * (1 - fx) + texel(x0 + 1, y0) * fx) * (1 - fy) +
         (texel(x0, y0 + 1) * (1 - fx) + texel(x0 + 1, y0 + 1) * fx) * fy;
}

TEST(SamplerState, HalfFloatsKeepTheRangeWithinTheirRounding) {
  const Plane<float4> image = half_noise(32, 16);
  const Texture texture(image, TexelMeaning::Color);
  ASSERT_NE(texture.view().halves, nullptr);
  for (const Wrap wrap : {Wrap::Repeat, Wrap::Mirror, Wrap::Clamp}) {
    const SamplerState filtering = make_filtering({.wrap_u = wrap, .wrap_v = wrap});
    Points points;
    for (std::uint32_t i = 0; i < 128; ++i) {
      const std::uint32_t word = hash(i, 11);
      points.add(static_cast<float>(static_cast<int>(word % 448) - 192) / 64,
                 static_cast<float>(static_cast<int>(word / 448 % 448) - 192) / 64, 2.0f / 32);  // level 1
    }
    const Values values = look_up(texture, filtering, points);
    float most = 0;
    for (int i = 0; i < points.count; ++i)
      for (int c = 0; c < 4; ++c) {
        const double expected = bilinear_of_means(image, c, points.u[i], points.v[i], wrap, wrap);
        // A texel of level 1 is rounded to 11 bits; the mean of nonnegative texels has no greater relative error. Nine
        // roundings to float may each be off by half a unit of the greatest texel.
        ASSERT_NEAR(values.channel[c][i], expected, expected * 0x1p-11 + 9 * 0x1p-24 * (c == 3 ? 1 : 65536)) << i;
        most = std::max(most, values.channel[c][i]);
      }
    EXPECT_GT(most, 10000);
  }
}

/// An image whose level l holds the code 8 l + 4 everywhere: a view made by hand.
struct Staircase {
  std::vector<std::uint8_t> codes;
  TextureView view;

  Staircase(int width, int height) {
    for (int w = width, h = height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
      view.width[view.levels] = w, view.height[view.levels] = h;
      view.offset[view.levels] = static_cast<std::int32_t>(codes.size() / 4);
      const auto texels = static_cast<std::size_t>(RowPitch::of(w) * (h + 2));
      codes.resize(codes.size() + 4 * texels, static_cast<std::uint8_t>(8 * view.levels++ + 4));
      if (w == 1 && h == 1) break;
    }
    codes.resize(codes.size() + 8);
    view.unorm8 = codes.data();
  }
  /// The level at which each point looked.
  std::vector<double> levels(const SamplerState& filtering, const Points& points) const {
    static Taps taps;
    Values values;
    float* const out[4] = {values.channel[0], values.channel[1], values.channel[2], values.channel[3]};
    kernels(best_isa()).compute_taps(view, filtering, points.footprint(), taps, points.padded());
    kernels(best_isa()).mix_taps(view, taps, out, points.padded());
    std::vector<double> result;
    for (int i = 0; i < points.count; ++i) result.push_back((values.channel[0][i] * 255.0 - 4) / 8);
    return result;
  }
};

TEST(SamplerState, TheLevelIsLog2OfTheFootprint) {
  const Staircase stairs(256, 64);
  Points points;
  std::vector<double> expected;
  for (int i = 0; i < 128; ++i) {
    const auto random = [&](std::uint32_t k) {
      return (unit_float(hash(static_cast<std::uint32_t>(i), k)) - 0.5f) * 0.3f *
             std::exp2(-9 * unit_float(hash(static_cast<std::uint32_t>(i), 9)));
    };
    points.add(0.3f, 0.7f);
    points.dudx[i] = random(1), points.dvdx[i] = random(2), points.dudy[i] = random(3), points.dvdy[i] = random(4);
    const double x = std::hypot(points.dudx[i] * 256.0, points.dvdx[i] * 64.0);
    const double y = std::hypot(points.dudy[i] * 256.0, points.dvdy[i] * 64.0);
    expected.push_back(std::min(8.0, std::max(0.0, std::log2(std::max(x, y)))));
  }
  const auto trilinear = stairs.levels({}, points);
  const auto nearest = stairs.levels({.blends_mips = false}, points);
  const auto none = stairs.levels({.has_mips = false, .blends_mips = false}, points);
  for (int i = 0; i < points.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_NEAR(trilinear[at], expected[at], 1e-3);  // half a unit of 1/128 code is 1/2048 level
    EXPECT_NEAR(nearest[at], std::floor(expected[at] + 0.5), 1e-5);
    EXPECT_NEAR(none[at], 0, 1e-5);
  }
}

TEST(SamplerState, EachAxisOfTheFootprintCounts) {
  const Staircase stairs(256, 64);
  Points points;
  for (int axis = 0; axis < 4; ++axis) {
    points.add(0.1f, 0.2f);
    float* const derivatives[] = {points.dudx, points.dvdx, points.dudy, points.dvdy};
    derivatives[axis][axis] = axis % 2 == 0 ? 4.0f / 256 : 8.0f / 64;
  }
  const auto levels = stairs.levels({}, points);
  const double expected[] = {2, 3, 2, 3};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(levels[i], expected[i], 1e-3);
}

TEST(SamplerState, AnisotropicIsTheMeanOfProbesAlongTheFootprint) {
  const Texture texture(noise(64, 64, 3), TexelMeaning::Values);
  Points points;
  for (std::uint32_t i = 0; i < 128; ++i) {
    const auto random = [&](std::uint32_t k) { return unit_float(hash(i, k, 5)) - 0.5f; };
    points.add(3 * random(1), 3 * random(2));
    const auto at = static_cast<int>(i);
    points.dudx[at] = 0.5f * random(3), points.dvdx[at] = 0.5f * random(4);
    points.dudy[at] = 0.08f * random(5), points.dvdy[at] = 0.08f * random(6);
    if (i % 2 == 1) std::swap(points.dudx[at], points.dudy[at]), std::swap(points.dvdx[at], points.dvdy[at]);
  }
  SamplerState filtering;
  filtering.anisotropy = 8;
  const Values along = look_along(texture, filtering, points);
  int with_several = 0;
  for (int i = 0; i < points.count; ++i) {
    const double x = std::hypot(points.dudx[i], points.dvdx[i]) * 64,
                 y = std::hypot(points.dudy[i], points.dvdy[i]) * 64;
    const double longer = std::max(x, y), width = std::max(std::min(longer, std::max(std::min(x, y), 1.0)), longer / 8);
    const double n = std::ceil(longer / width * 2 / 3);
    const double du = x > y ? points.dudx[i] : points.dudy[i], dv = x > y ? points.dvdx[i] : points.dvdy[i];
    Points probes;
    for (int k = 0; k < static_cast<int>(n); ++k) {
      const double t = (k + 0.5) / n - 0.5;
      probes.add(static_cast<float>(points.u[i] + du * t), static_cast<float>(points.v[i] + dv * t),
                 static_cast<float>(width / 64));
    }
    const Values each = look_up(texture, {}, probes);
    for (int c = 0; c < 4; ++c) {
      double mean = 0;
      for (int k = 0; k < probes.count; ++k) mean += static_cast<double>(each.channel[c][k]) / n;
      ASSERT_NEAR(along.channel[c][i], mean, 2e-4) << i << " of " << n;
    }
    with_several += n > 1;
  }
  EXPECT_GT(with_several, 80);
}

TEST(SamplerState, AnisotropicIsTheSameForRoundFootprints) {
  const Texture texture(noise(64, 32, 3), TexelMeaning::Color);
  Points points;
  for (int i = 0; i < 64; ++i) {
    points.add(0.013f * static_cast<float>(i), 0.37f);
    points.dudx[i] = 0.04f, points.dvdy[i] = 0.08f;
  }
  SamplerState filtering;
  filtering.anisotropy = 16;
  const Values along = look_along(texture, filtering, points), plain = look_up(texture, {}, points);
  for (int c = 0; c < 4; ++c)
    for (int i = 0; i < points.count; ++i) ASSERT_EQ(along.channel[c][i], plain.channel[c][i]);
}

TEST(SamplerState, MagnifyAndMinifyHaveTheirOwnFilters) {
  Rgba8Image image(2, 2);
  image(1, 0) = image(1, 1) = {255, 255, 255, 255};
  const Texture texture(image, TexelMeaning::Values);
  Points points;
  points.add(0.375f, 0.5f, 0.25f), points.add(0.375f, 0.5f, 0.75f);
  const SamplerState none{.has_mips = false, .blends_mips = false};
  SamplerState sharp_near = none, sharp_far = none;
  sharp_near.nearest_magnify = true, sharp_far.nearest_minify = true;
  EXPECT_EQ(look_up(texture, sharp_near, points).channel[0][0], 0.0f);
  EXPECT_EQ(look_up(texture, sharp_near, points).channel[0][1], 0.25f);
  EXPECT_EQ(look_up(texture, sharp_far, points).channel[0][0], 0.25f);
  EXPECT_EQ(look_up(texture, sharp_far, points).channel[0][1], 0.0f);
}

/// Coordinates and derivatives of all kinds: usual, huge, infinite, not a number.
Points wild_points(int count, bool is_sane) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const float odd[] = {0.0f,
                       -0.0f,
                       1.0f,
                       -1.0f,
                       1e-9f,
                       -1e-9f,
                       0.99999994f,
                       3e7f,
                       1e38f,
                       -1e38f,
                       infinity,
                       -infinity,
                       std::numeric_limits<float>::quiet_NaN()};
  Points points;
  points.count = count;
  float* const arrays[] = {points.u, points.v, points.dudx, points.dvdx, points.dudy, points.dvdy};
  for (std::uint32_t a = 0; a < 6; ++a)
    for (std::uint32_t i = 0; i < capacity; ++i) {
      const std::uint32_t word = hash(i, a, 17);
      const float scale = a < 2 ? 6.0f : 0.2f;
      arrays[a][i] = (unit_float(word) - 0.5f) * scale;
      if (!is_sane && word % 5 == 0) arrays[a][i] = odd[hash(word) % std::size(odd)];
    }
  return points;
}

std::vector<SamplerState> all_filterings() {
  std::vector<SamplerState> all;
  for (int bits = 0; bits < 256; ++bits) {
    const auto bit = [&](int k) { return ((bits >> k) & 1) != 0; };
    if ((bit(0) && bit(1)) || (bit(2) && bit(3)) || (!bit(6) && bit(7))) continue;
    all.push_back({bit(0), bit(1), bit(2), bit(3), bit(4), bit(5), bit(6), bit(7)});
  }
  return all;
}

TEST(SamplerState, NoPlaceLeavesTheTexture) {
  static Taps taps;
  const Points points = wild_points(128, false);
  const int sizes[][2] = {{64, 64}, {13, 5}, {1, 1}};
  for (const auto& size : sizes) {
    const Texture texture(noise(size[0], size[1], 3), TexelMeaning::Values);
    const TextureView& view = texture.view();
    const int texels = view.offset[view.levels - 1] + 9 + 2;
    for (const SamplerState& filtering : all_filterings())
      for (const Isa isa : supported_isas()) {
        kernels(isa).compute_taps(view, filtering, points.footprint(), taps, points.padded());
        for (int l = 0; l < (filtering.blends_mips ? 2 : 1); ++l)
          for (int i = 0; i < points.count; ++i)
            for (const std::int32_t left : {taps.upper[l][i], taps.lower[l][i]}) {
              ASSERT_GE(left, 0);
              ASSERT_LT(left + 1, texels);
              ASSERT_GE(taps.right(l, i), 0);
              ASSERT_GE(taps.down(l, i), 0);
            }
      }
  }
}

TEST(SamplerState, OneColourIsOneColourEverywhere) {
  const Points points = wild_points(128, true);
  for (const TexelMeaning meaning : {TexelMeaning::Values, TexelMeaning::Color}) {
    const Texture textures[] = {Texture(Rgba8Image(37, 16, Rgba8{51, 200, 3, 99}), meaning),
                                Texture(Rgba16Image(37, 16, Rgba16{51, 20000, 3, 99}), meaning),
                                Texture(Plane<float4>(37, 16, float4{1e4f, 0.1f, 1e-40f, 0.3f}), meaning),
                                Texture(Plane<float4>(37, 16, float4{1e4f, 0.125f, 0x1p-24f, 0.75f}), meaning)};
    Points centre;
    centre.add(0.5f, 0.5f);
    for (const Texture& texture : textures)
      for (const SamplerState& filtering : all_filterings()) {
        const Values one = look_up(texture, filtering, centre), many = look_up(texture, filtering, points);
        for (int c = 0; c < 4; ++c)
          for (int i = 0; i < points.count; ++i) ASSERT_EQ(many.channel[c][i], one.channel[c][0]);
      }
  }
}

/// All nonnegative finite half floats, the subnormal ones too.
Plane<float4> all_halves() {
  Plane<float4> image(248, 32);
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    const auto value = [&](std::size_t channel) { return half_value(static_cast<std::uint16_t>(4 * i + channel)); };
    image.values()[i] = {value(0), value(1), value(2), std::min(value(3), 1.0f)};
  }
  return image;
}

TEST(SamplerState, EveryHalfFloatIsConvertedExactly) {
  const Plane<float4> image = all_halves();
  const Texture texture(image, TexelMeaning::Color);
  ASSERT_NE(texture.view().halves, nullptr);
  const SamplerState nearest =
      make_filtering({.magnify = TexelFilter::Nearest, .minify = TexelFilter::Nearest, .level = LevelFilter::None});
  for (int y = 0; y < image.height(); ++y)
    for (const Isa isa : supported_isas()) {
      Points points;
      for (int x = 0; x < image.width(); ++x)
        points.add((static_cast<float>(x) + 0.5f) / 248, (static_cast<float>(y) + 0.5f) / 32);
      const Values values = look_up(texture, nearest, points, isa);
      for (int x = 0; x < image.width(); ++x) {
        const float4& p = image(x, y);
        ASSERT_EQ(values.channel[0][x], p.x) << name_of(isa);
        ASSERT_EQ(values.channel[1][x], p.y);
        ASSERT_EQ(values.channel[2][x], p.z);
        ASSERT_EQ(values.channel[3][x], p.w);
      }
    }
}

TEST(SamplerState, EveryInstructionSetGivesTheSameBits) {
  const Texture textures[] = {
      Texture(noise(64, 32, 3), TexelMeaning::Color), Texture(noise(19, 44, 3), TexelMeaning::Values),
      Texture(bright_noise(19, 44), TexelMeaning::Color), Texture(half_noise(19, 44), TexelMeaning::Color),
      Texture(all_halves(), TexelMeaning::Color)};
  const auto filterings = all_filterings();
  for (int count = 0; count <= 128; ++count) {
    const Points points = wild_points(count, false);
    SamplerState filtering = filterings[static_cast<std::size_t>(count) * 7 % filterings.size()];
    filtering.anisotropy = 1 + count % 16;
    for (const Texture& texture : textures) {
      const Values expected = look_up(texture, filtering, points, Isa::Scalar);
      const Values expected_along = look_along(texture, filtering, points, Isa::Scalar);
      for (const Isa isa : supported_isas()) {
        const Values values = look_up(texture, filtering, points, isa);
        const Values along = look_along(texture, filtering, points, isa);
        for (int c = 0; c < 4; ++c)
          ASSERT_EQ(
              std::memcmp(along.channel[c], expected_along.channel[c], sizeof(float) * static_cast<std::size_t>(count)),
              0)
              << name_of(isa) << " " << count;
        for (int c = 0; c < 4; ++c)
          ASSERT_EQ(
              std::memcmp(values.channel[c], expected.channel[c], sizeof(float) * static_cast<std::size_t>(count)), 0)
              << name_of(isa) << " " << count;
      }
    }
  }
}

}  // namespace
}  // namespace zoneplate
