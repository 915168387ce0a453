// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/prepared_environment.h"

#include <gtest/gtest.h>

#include <cstring>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/environment.h"
#include "zoneplate/shade/environment/equirectangular.h"
#include "zoneplate/shade/environment/light_tree.h"
#include "zoneplate/shade/environment/lookup.h"
#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/environment/prefilter.h"
#include "zoneplate/shade/reflection/brdf.h"

namespace zoneplate {
namespace {

using F = scalar::Float;
constexpr double pi = std::numbers::pi;

/// A room with a gradient, a window and a lamp that is a few hundred times brighter than the walls.
float4 room_light(double u, double v) {
  const auto in = [&](double u0, double u1, double v0, double v1) { return u > u0 && u < u1 && v > v0 && v < v1; };
  if (in(0.61, 0.63, 0.25, 0.29)) return {120, 90, 60, 1};
  if (in(0.2, 0.35, 0.3, 0.5)) return {4, 6, 9, 1};
  return {static_cast<float>(0.2 + 0.3 * v), 0.3f, static_cast<float>(0.5 - 0.3 * v), 1};
}

TexelImage room(int width) {
  Plane<float4> image(width, width / 2);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < width; ++x) image(x, y) = room_light((x + 0.5) / width, (y + 0.5) / (width / 2));
  return image;
}

/// The mean of the image over the lobe, by the sum over parts of every pixel: 2^20 directions for a width of 512.
struct Mean {
  double r, g, b;
};
template <class LightAt>
Mean brute_force(const Plane<float4>& image, int parts, float3 n, double alpha, const LightAt& light_at) {
  double sum[4] = {};
  const int columns = image.width() * parts, rows = image.height() * parts;
  for (int y = 0; y < rows; ++y) {
    const double v = (y + 0.5) / rows, sine = std::sin(pi * v), up = std::cos(pi * v);
    for (int x = 0; x < columns; ++x) {
      const double phi = 2 * pi * (x + 0.5) / columns;
      const double c = -std::cos(phi) * sine * double{n.x} + up * double{n.y} - std::sin(phi) * sine * double{n.z};
      if (c <= 0) continue;
      const double u = (1 - c) / 2, d = u + alpha * alpha * (1 - u), weight = c / (d * d) * sine;
      const Mean light = light_at((x + 0.5) / parts, (y + 0.5) / parts);
      sum[0] += weight * light.r, sum[1] += weight * light.g, sum[2] += weight * light.b, sum[3] += weight;
    }
  }
  return {sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
}
Mean brute_force(const Plane<float4>& image, float3 n, double alpha) {
  return brute_force(image, 3, n, alpha, [&](double x, double y) {
    const float4 light = image(static_cast<int>(x), static_cast<int>(y));
    return Mean{light.x, light.y, light.z};
  });
}
/// The same where the image is bilinear between its pixels.
Mean brute_force_of_bilinear(const Plane<float4>& image, float3 n, double alpha) {
  return brute_force(image, 6, n, alpha, [&](double x, double y) {
    const int left = static_cast<int>(std::floor(x - 0.5)), above = static_cast<int>(std::floor(y - 0.5));
    const double right = x - 0.5 - left, down = y - 0.5 - above;
    Mean out{};
    for (int k = 0; k < 4; ++k) {
      const double part = (k % 2 == 0 ? 1 - right : right) * (k / 2 == 0 ? 1 - down : down);
      const float4 pixel =
          image((left + k % 2 + image.width()) % image.width(), std::clamp(above + k / 2, 0, image.height() - 1));
      out.r += part * double{pixel.x}, out.g += part * double{pixel.y}, out.b += part * double{pixel.z};
    }
    return out;
  });
}

EnvironmentView plain_view(const PreparedEnvironment& e) { return e.view({.color = {1, 1, 1}}, {0, 1, 0}); }

float3 value(Vector<F> v) { return {v.x.v, v.y.v, v.z.v}; }
Vector<F> lanes(float3 v) { return {F(v.x), F(v.y), F(v.z)}; }

TEST(Prefilter, IsTheIntegralOfTheLobe) {
  const TexelImage image = room(512);
  const LightTree tree = make_light_tree(cube_of_equirectangular(image, 256));
  const struct {
    float roughness;
    double bound;
  } cases[] = {{0.2f, 0.005}, {0.4f, 0.005}, {0.7f, 0.005}, {1, 0.005}};
  for (const auto& [roughness, bound] : cases)
    for (int k = 0; k < 6; ++k) {
      DirectionBlock block;
      const float3 n = normalize({static_cast<float>(std::cos(k * 2.4)), 0.3f * static_cast<float>(k - 3),
                                  static_cast<float>(std::sin(k * 2.4))});
      for (int i = 0; i < DirectionBlock::size; ++i) block.x[i] = n.x, block.y[i] = n.y, block.z[i] = n.z;
      RadianceBlock light;
      PrefilterKernels::of().filter(tree, {.alpha = {roughness * roughness}}, block, &light);
      const Mean mean = brute_force(image.as<float4>(), n, static_cast<double>(roughness) * roughness);
      EXPECT_NEAR(light.r[0] / mean.r, 1, bound) << roughness << ' ' << k;
      EXPECT_NEAR(light.b[15] / mean.b, 1, bound) << roughness << ' ' << k;
    }
}

TEST(Prefilter, EachChannelHasItsOwnCentroid) {
  // Every channel is bright in other pixels.
  Plane<float4> pixels(256, 128, {});
  for (int i = 0; i < 256 * 128; ++i) {
    const auto light = [&](std::uint32_t channel) {
      const float u = unit_float(hash(static_cast<std::uint32_t>(i), channel)), square = u * u,
                  fourth = square * square;
      return 0.1f + 40 * fourth * fourth;
    };
    pixels(i % 256, i / 256) = {light(1), light(2), light(3), 1};
  }
  const TexelImage image(std::move(pixels));
  const LightTree tree = make_light_tree(cube_of_equirectangular(image, 128));
  for (const float roughness : {0.3f, 0.5f, 1.0f})
    for (int k = 0; k < 8; ++k) {
      DirectionBlock block;
      const double turn = 2 * pi * (52 + 5 * k) / 256, height = 0.2 * (k % 3);
      const float3 n = normalize(
          {static_cast<float>(-std::cos(turn)), static_cast<float>(0.1 + height), static_cast<float>(-std::sin(turn))});
      for (int i = 0; i < DirectionBlock::size; ++i) block.x[i] = n.x, block.y[i] = n.y, block.z[i] = n.z;
      RadianceBlock fast, slow;
      PrefilterKernels::of().filter(tree, {.alpha = {roughness * roughness}, .detail = 0.58f}, block, &fast);
      PrefilterKernels::of().filter(tree, {.alpha = {roughness * roughness}, .detail = 0.05f}, block, &slow);
      EXPECT_NEAR(fast.r[0] / slow.r[0], 1, 0.001) << roughness << ' ' << k;
      EXPECT_NEAR(fast.g[0] / slow.g[0], 1, 0.001) << roughness << ' ' << k;
      EXPECT_NEAR(fast.b[0] / slow.b[0], 1, 0.001) << roughness << ' ' << k;
    }
}

/// Directions with weights, whose radiance is the look-up of roughness 0.
struct Quadrature {
  std::vector<float> direction[3];
  std::vector<double> weight;

  void add(float3 d, double w) {
    direction[0].push_back(d.x), direction[1].push_back(d.y), direction[2].push_back(d.z), weight.push_back(w);
  }
  Mean mean(const EnvironmentView& view) const {
    std::vector<float> light[3];
    for (auto& channel : light) channel.resize(weight.size());
    const float* const from[3] = {direction[0].data(), direction[1].data(), direction[2].data()};
    float* const to[3] = {light[0].data(), light[1].data(), light[2].data()};
    LookupKernels::of().specular(view, from, 0, to, static_cast<int>(weight.size()));
    double sum[4] = {};
    for (std::size_t i = 0; i < weight.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weight[i] * static_cast<double>(light[c][i]);
      sum[3] += weight[i];
    }
    return {sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
  }
};

/// Half a million directions about n with the weights of the lobe, by angles that are evenly spaced up to α and
/// geometrically beyond.
Quadrature lobe_quadrature(float3 n, double alpha) {
  constexpr int rings = 640, turns = 800;
  const float3 x = normalize(cross(std::abs(n.y) < 0.9f ? float3{0, 1, 0} : float3{1, 0, 0}, n)), y = cross(n, x);
  Quadrature out;
  for (int i = 0; i < rings; ++i) {
    const double angle = alpha * (std::exp(std::log(1 + pi / 2 / alpha) * (i + 0.5) / rings) - 1);
    const double sine = std::sin(angle), half = std::sin(angle / 2), u = half * half, d = u + alpha * alpha * (1 - u);
    for (int k = 0; k < turns; ++k) {
      const double turn = 2 * pi * (k + 0.5) / turns;
      out.add(n * static_cast<float>(std::cos(angle)) + x * static_cast<float>(sine * std::cos(turn)) +
                  y * static_cast<float>(sine * std::sin(turn)),
              std::cos(angle) / (d * d) * sine * (angle + alpha));
    }
  }
  return out;
}

TEST(LookUp, IsTheIntegralOfTheLobeAtEveryRoughness) {
  const PreparedEnvironment environment = prepare_equirectangular(room(256));
  const EnvironmentView view = plain_view(environment);
  const float3 lamp = normalize({-std::cos(2 * 3.14159265f * 0.62f), 0.27f, -std::sin(2 * 3.14159265f * 0.62f)});
  for (const float roughness : {0.03f, 0.06f, 0.1f, 0.15f, 0.22f, 0.3f, 0.5f, 0.7f, 1.0f})
    for (std::uint32_t k = 0; k < 4; ++k) {
      float3 n =
          normalize({unit_float(hash(k, 1)) - 0.5f, unit_float(hash(k, 2)) - 0.5f, unit_float(hash(k, 3)) - 0.5f});
      if (k > 2) n = normalize(lamp + n * (2 * roughness));  // where the light changes most
      const double alpha = static_cast<double>(roughness) * roughness;
      const Mean expected = lobe_quadrature(n, alpha).mean(view);
      const float3 found = value(specular_light(view, lanes(n), F(roughness)));
      const double bound = 0.005;
      EXPECT_NEAR(found.x / expected.r, 1, bound) << roughness << ' ' << k;
      EXPECT_NEAR(found.z / expected.b, 1, bound) << roughness << ' ' << k;
      if (roughness < 1) continue;
      EXPECT_NEAR(value(diffuse_light(view, lanes(n))).y / expected.g, 1, 0.005) << k;
    }
}

// The spline that the texels control is wider than the lamps of the image; lobes that are wider than texels are not.
TEST(LookUp, IsTheIntegralOfTheImageForWideLobes) {
  constexpr int width = 128;
  Plane<float4> pixels(width, width / 2, {1, 1, 1, 1});
  pixels(81, 17) = {2000, 1000, 500, 1};
  const double turn = 2 * pi * 81.5 / width, polar = pi * 17.5 / (width / 2);
  const float3 lamp{static_cast<float>(-std::cos(turn) * std::sin(polar)), static_cast<float>(std::cos(polar)),
                    static_cast<float>(-std::sin(turn) * std::sin(polar))};
  const TexelImage image(std::move(pixels));
  CubeImage cube = cube_of_equirectangular(image, 64);
  const PreparedEnvironment environment(cube);
  cube.source.clear();
  const PreparedEnvironment as_wide_as_the_spline(cube);
  for (const float roughness : {0.2f, 0.3f, 0.5f}) {
    double most = 0, max_of_spline = 0;
    for (std::uint32_t k = 0; k < 6; ++k) {
      const float3 away{unit_float(hash(k, 1)) - 0.5f, unit_float(hash(k, 2)) - 0.5f, unit_float(hash(k, 3)) - 0.5f};
      const float3 n = normalize(lamp + away * (static_cast<float>(k) * roughness * roughness));
      const Mean expected = brute_force_of_bilinear(image.as<float4>(), n, static_cast<double>(roughness) * roughness);
      const auto error = [&](const PreparedEnvironment& e) {
        const float3 found = value(specular_light(plain_view(e), lanes(n), F(roughness)));
        return std::max(std::abs(double{found.x} / expected.r - 1), std::abs(double{found.z} / expected.b - 1));
      };
      most = std::max(most, error(environment));
      max_of_spline = std::max(max_of_spline, error(as_wide_as_the_spline));
    }
    EXPECT_LT(most, 0.004) << roughness;
    if (roughness < 0.4f) {
      EXPECT_GT(max_of_spline, 2 * most) << roughness;
    }
  }
}

/// The integral of the lobe over all directions: about n, over the half angle's square u, of the solid angle 4π du.
double lobe_integral(double alpha) {
  constexpr int steps = 100000;
  const double octaves = std::log(1 + 0.5 / (alpha * alpha));
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double u = alpha * alpha * (std::exp(octaves * (i + 0.5) / steps) - 1);
    const double d = u + alpha * alpha * (1 - u);
    sum += (1 - 2 * u) / (d * d) * (u + alpha * alpha) * octaves / steps;
  }
  return 4 * pi * sum;
}

/// The quadratic B-spline at t, in texels.
double spline_at(double t) {
  const double x = std::abs(t), rest = 1.5 - x;
  return x < 0.5 ? 0.75 - x * x : rest > 0 ? rest * rest / 2 : 0.0;
}

TEST(LookUp, IsTheIntegralBesideATexelThatIs8000TimesBrighter) {
  constexpr int side = 64, face = 2, column = 40, row = 23;
  constexpr double excess = 7999;
  CubeImage cube{side, std::vector<float3>(cube::faces * side * side, float3{1, 1, 1})};
  cube.texels[cube.index(face, column, row)] = {8000, 8000, 8000};
  const PreparedEnvironment environment(cube);
  const EnvironmentView view = plain_view(environment);
  // The integral is that of the constant, and of the texel's spline by 120 × 120 directions in each of nine texels.
  constexpr int parts = 360;
  struct Light {
    float3 direction;
    double weight;
  };
  std::vector<Light> lights;
  for (int k = 0; k < parts * parts; ++k) {
    const double x = 3.0 * (k % parts + 0.5) / parts - 1.5, y = 3.0 * (k / parts + 0.5) / parts - 1.5;
    const float3 p = cube::point(face, cube::centre(column, side) + static_cast<float>(2 * x / side),
                                 cube::centre(row, side) + static_cast<float>(2 * y / side));
    const double square = dot(p, p), area = 36.0 / (side * side) / (parts * parts);
    lights.push_back({normalize(p), spline_at(x) * spline_at(y) * area / (square * std::sqrt(square))});
  }
  const float3 bright = normalize(cube::point(face, cube::centre(column, side), cube::centre(row, side)));
  for (const float roughness : {0.15f, 0.2f, 0.25f, 0.3f, 0.4f, 0.5f, 0.7f, 1.0f}) {
    const double alpha = static_cast<double>(roughness) * roughness, whole = lobe_integral(alpha);
    for (std::uint32_t k = 0; k < 6; ++k) {
      const float3 r{unit_float(hash(k, 1)) - 0.5f, unit_float(hash(k, 2)) - 0.5f, unit_float(hash(k, 3)) - 0.5f};
      const float3 n = normalize(bright + r * (static_cast<float>(k) * roughness));
      double sum = 0;
      for (const Light& light : lights) {
        const float3 away = light.direction - n;
        const double u = static_cast<double>(dot(away, away)) / 4, d = u + alpha * alpha * (1 - u);
        sum += std::max(1 - 2 * u, 0.0) / (d * d) * light.weight;
      }
      const double expected = 1 + excess * sum / whole;
      EXPECT_NEAR(value(specular_light(view, lanes(n), F(roughness))).y / expected, 1, 0.005) << roughness << ' ' << k;
      if (roughness < 1) continue;
      EXPECT_NEAR(value(diffuse_light(view, lanes(n))).y / expected, 1, 0.005) << k;
    }
  }
}

/// The mean of the light of all directions that a rough surface reflects to a viewer at v, weighted by its lobe with
/// masking and shadowing.
Mean reflected(const EnvironmentView& view, float3 n, float3 v, float roughness) {
  constexpr int rings = 48, turns = 96;
  const float3 x = normalize(cross(std::abs(n.y) < 0.9f ? float3{0, 1, 0} : float3{1, 0, 0}, n)), y = cross(n, x);
  const F alpha(roughness * roughness), nv(dot(n, v));
  Quadrature out;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < turns; ++k) {
      const double cosine = (i + 0.5) / rings, sine = std::sqrt(1 - cosine * cosine), turn = 2 * pi * (k + 0.5) / turns;
      const float3 l = n * static_cast<float>(cosine) + x * static_cast<float>(sine * std::cos(turn)) +
                       y * static_cast<float>(sine * std::sin(turn));
      const float3 h = normalize(l + v);
      const F nl(static_cast<float>(cosine));
      const F lobe = ggx(F(dot(n, h)), lanes(cross(n, h)), alpha) * smith(nl, nv, alpha) * nl;
      out.add(l, static_cast<double>(lobe.v));
    }
  return out.mean(view);
}

TEST(LookUp, AboutTheDirectionOfALobeIsNearTheReflectedLight) {
  const PreparedEnvironment environment = prepare_equirectangular(room(64));
  const EnvironmentView view = plain_view(environment);
  // Bounds of the error over that about the mirror direction, in the root mean square over normals and views.
  const struct {
    float roughness;
    double bound;
  } cases[] = {{0.5f, 0.97}, {0.7f, 0.85}, {0.85f, 0.6}, {1, 0.4}};
  for (const auto& c : cases) {
    const float roughness = c.roughness;
    double bent = 0, mirrored = 0;
    for (std::uint32_t k = 0; k < 60; ++k) {
      const auto direction = [&](std::uint32_t seed) {
        const float3 r{unit_float(hash(k, seed)), unit_float(hash(k, seed + 1)), unit_float(hash(k, seed + 2))};
        return normalize(r - float3{0.5f, 0.5f, 0.5f});
      };
      const float3 n = direction(1);
      float3 v = direction(4);
      if (dot(n, v) < 0) v = -v;
      const double expected = reflected(view, n, v, roughness).r;
      const auto error = [&](Vector<F> towards) {
        const double d = static_cast<double>(value(specular_light(view, towards, F(roughness))).x) - expected;
        return d * d;
      };
      bent += error(lobe_direction(lanes(n), lanes(v), F(roughness)));
      mirrored += error(lanes(n * (2 * dot(n, v)) - v));
    }
    EXPECT_LT(std::sqrt(bent / mirrored), c.bound) << roughness;
  }
}

TEST(Prefilter, EveryInstructionSetGivesTheSameBits) {
  const LightTree tree = make_light_tree(cube_of_equirectangular(room(64), 32));
  for (const float alpha : {0.01f, 0.3f, 1.0f}) {
    DirectionBlock block;
    for (std::uint32_t i = 0; i < DirectionBlock::size; ++i) {
      const float3 n = normalize({unit_float(hash(i, 1)) - 0.5f, unit_float(hash(i, 2)) - 0.2f, 0.7f});
      block.x[i] = n.x, block.y[i] = n.y, block.z[i] = n.z;
    }
    RadianceBlock expected;
    PrefilterKernels::scalar.filter(tree, {.alpha = {alpha}}, block, &expected);
    for (const Isa isa : supported_isas()) {
      RadianceBlock light;
      PrefilterKernels::of(isa).filter(tree, {.alpha = {alpha}}, block, &light);
      for (int i = 0; i < DirectionBlock::size; ++i) {
        EXPECT_EQ(light.r[i], expected.r[i]) << name_of(isa) << i;
        EXPECT_EQ(light.b[i], expected.b[i]) << name_of(isa) << i;
      }
    }
  }
}

TEST(LookUp, EveryInstructionSetGivesTheSameBits) {
  const PreparedEnvironment environment = prepare_equirectangular(room(128));
  EnvironmentView view = plain_view(environment);
  // As many levels as there may be: those that are missing repeat the roughest.
  for (int level = view.levels; level <= EnvironmentView::max_levels; ++level)
    view.side[level] = view.side[view.levels], view.offset[level] = view.offset[view.levels];
  view.levels_per_octave *= (EnvironmentView::max_levels - 1) / static_cast<float>(view.levels - 1);
  view.levels = EnvironmentView::max_levels;
  constexpr int count = 512;
  std::vector<float> d[3], expected[3], found[3];
  for (std::uint32_t c = 0; c < 3; ++c) {
    for (std::uint32_t i = 0; i < count; ++i) d[c].push_back(unit_float(hash(i, c)) - 0.5f);
    // Directions along axes, of no length, and that are not numbers have a look-up too.
    d[c][c] = 0, d[c][3] = 0, d[c][4 + c] = std::numeric_limits<float>::quiet_NaN();
    expected[c].resize(count), found[c].resize(count);
  }
  const float* const from[3] = {d[0].data(), d[1].data(), d[2].data()};
  float* const to[3] = {expected[0].data(), expected[1].data(), expected[2].data()};
  float* const to_found[3] = {found[0].data(), found[1].data(), found[2].data()};
  for (const float roughness : {0.0f, 0.03f, 0.5f, 0.99f, 1.0f}) {
    LookupKernels::scalar.specular(view, from, roughness, to, count);
    for (const Isa isa : supported_isas()) {
      LookupKernels::of(isa).specular(view, from, roughness, to_found, count);
      for (int c = 0; c < 3; ++c) EXPECT_EQ(found[c], expected[c]) << name_of(isa) << ' ' << roughness;
    }
  }
}

TEST(PreparedEnvironment, DoesNotDependOnThreads) {
  const TexelImage image = room(128);
  std::vector<float3> found[2];
  for (const int threads : {1, 5})
    with_threads(threads, [&] {
      const PreparedEnvironment environment = prepare_equirectangular(image);
      const EnvironmentView view = plain_view(environment);
      for (std::uint32_t i = 0; i < 400; ++i)
        found[threads == 5].push_back(value(specular_light(
            view, lanes({unit_float(hash(i, 1)) - 0.5f, unit_float(hash(i, 2)) - 0.5f, unit_float(hash(i, 3)) - 0.5f}),
            F(unit_float(hash(i, 4))))));
    });
  EXPECT_EQ(found[0], found[1]);
}

TEST(PreparedEnvironment, DISABLED_TheLargestHasTheMostBytes) {
  constexpr int side = PreparedEnvironment::largest_side;
  CubeImage cube{side, std::vector<float3>(cube::faces * side * side, float3{1, 1, 1})};
  cube.texels[cube.index(2, 300, 200)] = {8000, 8000, 8000};
  const PreparedEnvironment environment(cube);
  const std::vector<std::uint8_t> bytes = environment.bytes();
  EXPECT_EQ(bytes.size(), PreparedEnvironment::max_bytes());
  EXPECT_TRUE(PreparedEnvironment::from_bytes(bytes).has_value());
}

// Bytes whose hash is right, as of a file of a cache that another program has written.
TEST(PreparedEnvironment, BytesWithValuesThatAreNotFiniteAreDamaged) {
  const PreparedEnvironment environment = prepare_equirectangular(Plane<float4>(64, 32, {0.5f, 1, 2, 1}));
  constexpr std::size_t header = 48, hash = header - sizeof(std::uint64_t), mean = 16;
  const auto is_accepted = [&](std::size_t at, float value) {
    std::vector<std::uint8_t> bytes = environment.bytes();
    std::memcpy(bytes.data() + at, &value, sizeof value);
    const std::uint64_t number = content_hash(std::span(bytes).subspan(header));
    std::memcpy(bytes.data() + hash, &number, sizeof number);
    return PreparedEnvironment::from_bytes(bytes).has_value();
  };
  EXPECT_TRUE(is_accepted(header + 400, -1.5f));
  EXPECT_TRUE(is_accepted(mean, 1.5f));
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()}) {
    EXPECT_FALSE(is_accepted(header + 400, value));
    EXPECT_FALSE(is_accepted(mean, value));
  }
}

TEST(PreparedEnvironment, ConstantLightStaysConstant) {
  const TexelImage image = Plane<float4>(64, 32, {0.5f, 1, 2, 1});
  const PreparedEnvironment environment = prepare_equirectangular(image);
  const EnvironmentView view = plain_view(environment);
  for (std::uint32_t i = 0; i < 200; ++i) {
    const float3 d{unit_float(hash(i, 1)) - 0.5f, unit_float(hash(i, 2)) - 0.5f, unit_float(hash(i, 3)) - 0.5f};
    const float3 light = value(specular_light(view, lanes(d), F(unit_float(hash(i, 4)))));
    EXPECT_NEAR(light.x, 0.5f, 1e-5f);
    EXPECT_NEAR(light.z, 2, 4e-5f);
    EXPECT_NEAR(value(diffuse_light(view, lanes(d))).y, 1, 2e-5f);
  }
  EXPECT_NEAR(environment.mean().y, 1, 1e-5f);
}

TEST(PreparedEnvironment, HasNoSeamsBetweenFaces) {
  const PreparedEnvironment environment = prepare_equirectangular(room(128));
  const EnvironmentView view = plain_view(environment);
  // Two directions on either side of an edge of the cube, for every edge direction and roughness.
  for (const float roughness : {0.1f, 0.3f, 0.8f})
    for (int k = -20; k <= 20; ++k) {
      const float t = static_cast<float>(k) / 20.5f;
      const float3 a = value(specular_light(view, lanes({1, 0.9999f, t}), F(roughness)));
      const float3 b = value(specular_light(view, lanes({0.9999f, 1, t}), F(roughness)));
      EXPECT_NEAR(a.x / b.x, 1, 0.02) << roughness << ' ' << k;
    }
}

TEST(PreparedEnvironment, DirectionsFollowTheImage) {
  // The pixel in the middle of the right half, a little above the horizon.
  Plane<float4> image(64, 32, {0, 0, 0, 1});
  image(48, 15) = image(47, 15) = {100, 100, 100, 1};
  const PreparedEnvironment environment = prepare_equirectangular(TexelImage(image));
  const auto light = [&](const Environment& e, float3 up, float3 d) {
    return value(specular_light(environment.view(e, up), lanes(d), F(0.0f))).x;
  };
  const Environment plain{.color = {1, 1, 1}};
  EXPECT_GT(light(plain, {0, 1, 0}, {0, 0.05f, 1}), 10);
  EXPECT_NEAR(light(plain, {0, 1, 0}, {0, 0.05f, -1}), 0, 1e-4f);
  // A quarter turn to the left as seen from above takes +z to +x.
  EXPECT_GT(light({.color = {1, 1, 1}, .rotation = 1.57079633f}, {0, 1, 0}, {1, 0.05f, 0}), 10);
  // Where +z is up, the front is -y.
  EXPECT_GT(light(plain, {0, 0, 1}, {0, -1, 0.05f}), 10);
  EXPECT_FLOAT_EQ(light({.color = {1, 1, 1}, .strength = 2}, {0, 1, 0}, {0, 0.05f, 1}),
                  2 * light(plain, {0, 1, 0}, {0, 0.05f, 1}));
}

}  // namespace
}  // namespace zoneplate
