// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/environment.h"
#include "zoneplate/shade/environment/bordered_cube.h"
#include "zoneplate/shade/environment/equirectangular.h"
#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/environment/studio.h"

namespace zoneplate {
namespace {

using F = scalar::Float;
constexpr double pi = std::numbers::pi;

struct Direction {
  double x, y, z;
};
double dot_of(Direction a, Direction b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double squared_distance(Direction a, Direction b) {
  const Direction d{a.x - b.x, a.y - b.y, a.z - b.z};
  return dot_of(d, d);
}
Direction unit(Direction d) {
  const double length = std::sqrt(dot_of(d, d));
  return {d.x / length, d.y / length, d.z / length};
}

struct Light {
  Direction direction;
  double solid_angle;
  std::array<double, 3> radiance;
};

/// Radiance over all directions, in cells in each of which it is a polynomial of two coordinates in [0, 1].
class Radiance {
 public:
  virtual ~Radiance() = default;
  virtual int cells() const = 0;
  /// At a point of a cell; `solid_angle` is that per unit of both coordinates.
  virtual Light at(int cell, double x, double y) const = 0;

  void prepare() {
    cells_.resize(static_cast<std::size_t>(cells()));
    lights_.resize(9 * cells_.size());
    parallel_for(cells_.size(), [&](std::size_t k) {
      const int cell = static_cast<int>(k);
      const auto corner = [&](double x, double y) { return at(cell, x, y).direction; };
      cells_[k] = {corner(0.5, 0.5), std::sqrt(std::max(squared_distance(corner(0, 0), corner(1, 1)),
                                                        squared_distance(corner(0, 1), corner(1, 0))))};
      for (int i = 0; i < 9; ++i) lights_[9 * k + static_cast<std::size_t>(i)] = gauss(cell, i, 0, 0, 1);
    });
  }

  /// The mean weighted by the lobe of GGX, by the rule of Gauss of 3 × 3 points in every cell, or in equal parts of
  /// cells that are near n or at the horizon.
  std::array<double, 3> mean(Direction n, double alpha) const {
    double sums[4] = {};
    const auto add = [&](const Light& light) {
      const double cosine = dot_of(light.direction, n);
      if (cosine <= 0) return;
      const double u = squared_distance(light.direction, n) / 4, d = u + alpha * alpha * (1 - u);
      const double weight = cosine / (d * d) * light.solid_angle;
      for (std::size_t c = 0; c < 3; ++c) sums[c] += weight * light.radiance[c];
      sums[3] += weight;
    };
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const double width = cells_[k].width, cosine = dot_of(cells_[k].middle, n);
      if (cosine < -width) continue;
      const double distance = std::sqrt(squared_distance(cells_[k].middle, n)) - width / 2;
      int parts = std::clamp(static_cast<int>(std::ceil(width / (0.5 * std::max(distance, 2 * alpha)))), 1, 64);
      if (std::abs(cosine) < width) parts = std::max(parts, 3);
      for (int p = 0; p < parts * parts; ++p)
        for (int i = 0; i < 9; ++i)
          add(parts == 1 ? lights_[9 * k + static_cast<std::size_t>(i)]
                         : gauss(static_cast<int>(k), i, p % parts, p / parts, parts));
    }
    return {sums[0] / sums[3], sums[1] / sums[3], sums[2] / sums[3]};
  }

  /// The direction of the brightest cell, and its width.
  std::pair<Direction, double> brightest() const {
    const auto power = [&](std::size_t k) {
      const auto& c = lights_[9 * k + 4].radiance;
      return c[0] + c[1] + c[2];
    };
    std::size_t best = 0;
    for (std::size_t k = 1; k < cells_.size(); ++k)
      if (power(k) > power(best)) best = k;
    return {cells_[best].middle, cells_[best].width};
  }

 private:
  Light gauss(int cell, int i, int x, int y, int parts) const {
    static const double offset = std::sqrt(0.6) / 2, place[3] = {0.5 - offset, 0.5, 0.5 + offset},
                        weight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    Light light = at(cell, (x + place[i % 3]) / parts, (y + place[i / 3]) / parts);
    light.solid_angle *= weight[i % 3] * weight[i / 3] / (parts * parts);
    return light;
  }

  struct Cell {
    Direction middle;
    double width;
  };
  std::vector<Cell> cells_;
  std::vector<Light> lights_;
};

/// The spline that an environment has at roughness 0.
class SplineRadiance : public Radiance {
 public:
  explicit SplineRadiance(const CubeImage& cube) : points_(with_border(cube)) { prepare(); }
  int cells() const override { return cube::faces * points_.side * points_.side; }
  Light at(int cell, double x, double y) const override {
    const int side = points_.side, column = cell % side, row = cell / side % side, face = cell / (side * side);
    const auto weights = [](double t) {
      return std::array{(1 - t) * (1 - t) / 2, 0.75 - (t - 0.5) * (t - 0.5), t * t / 2};
    };
    const auto across = weights(x), down = weights(y);
    Light light{};
    for (int k = 0; k < 9; ++k) {
      const float3 point = points_.at(face, column + k % 3 - 1, row + k / 3 - 1);
      const double weight = across[static_cast<std::size_t>(k % 3)] * down[static_cast<std::size_t>(k / 3)];
      light.radiance[0] += weight * point.x, light.radiance[1] += weight * point.y,
          light.radiance[2] += weight * point.z;
    }
    const double s = (column + x) * 2 / side - 1, t = (row + y) * 2 / side - 1, one = face % 2 == 0 ? 1 : -1;
    const Direction d = face < 2 ? Direction{one, s, t} : face < 4 ? Direction{t, one, s} : Direction{s, t, one};
    const double square = dot_of(d, d);
    light.direction = unit(d), light.solid_angle = 4.0 / (side * side) / (square * std::sqrt(square));
    return light;
  }

 private:
  BorderedCube points_;
};

/// An equirectangular image, bilinear between its pixels.
class ImageRadiance : public Radiance {
 public:
  explicit ImageRadiance(const TexelImage& image) : light_(light_of(image)) { prepare(); }
  int cells() const override { return light_.width() * (light_.height() + 1); }
  Light at(int cell, double x, double y) const override {
    const int width = light_.width(), height = light_.height(), column = cell % width, row = cell / width - 1;
    // Half of the cells of the first and the last row lie beyond the image.
    const double first = row < 0 ? 0.5 : 0, last = row == height - 1 ? 0.5 : 1, v = first + (last - first) * y;
    Light light{};
    for (int k = 0; k < 4; ++k) {
      const float3 pixel = light_((column + k % 2) % width, std::clamp(row + k / 2, 0, height - 1));
      const double weight = (k % 2 == 0 ? 1 - x : x) * (k / 2 == 0 ? 1 - v : v);
      light.radiance[0] += weight * pixel.x, light.radiance[1] += weight * pixel.y,
          light.radiance[2] += weight * pixel.z;
    }
    const double turn = 2 * pi * (column + 0.5 + x) / width, angle = pi * (row + 0.5 + v) / height;
    light.direction = {-std::cos(turn) * std::sin(angle), std::cos(angle), -std::sin(turn) * std::sin(angle)};
    light.solid_angle = 2 * pi / width * pi / height * std::sin(angle) * (last - first);
    return light;
  }

 private:
  Plane<float3> light_;
};

/// Prints the errors of look-ups relative to the integral, in directions at random and near the brightest light;
/// returns the greatest by roughness.
std::vector<double> print_errors(const char* title, const EnvironmentView& view, const Radiance& radiance,
                                 const std::vector<float>& roughnesses) {
  constexpr int count = 24;
  std::printf("%s\n", title);
  const auto [bright, width] = radiance.brightest();
  std::vector<double> greatest;
  for (const float roughness : roughnesses) {
    const double alpha = static_cast<double>(roughness) * roughness;
    std::array<double, 2 * count> errors, diffuse;
    parallel_for(errors.size(), [&, bright = bright, width = width](std::size_t i) {
      const auto k = static_cast<std::uint32_t>(i) + 1000 * static_cast<std::uint32_t>(roughness * 1000);
      const auto normal = [&](std::uint32_t s) {
        return std::sqrt(-2 * std::log(static_cast<double>(unit_float(hash(k, s))) + 1e-9)) *
               std::cos(2 * pi * static_cast<double>(unit_float(hash(k, s + 1))));
      };
      Direction n{normal(1), normal(3), normal(5)};
      if (i >= count) {
        const double reach = 4 * std::max(alpha, width / 1.4) * static_cast<double>(unit_float(hash(k, 7)));
        n = {bright.x + n.x * reach, bright.y + n.y * reach, bright.z + n.z * reach};
      }
      n = unit(n);
      const Vector<F> lanes{F(static_cast<float>(n.x)), F(static_cast<float>(n.y)), F(static_cast<float>(n.z))};
      const auto expected = radiance.mean(n, std::max(alpha, 1e-6));
      const auto error = [&](Vector<F> found) {
        return std::max({std::abs(static_cast<double>(found.x.v) / expected[0] - 1),
                         std::abs(static_cast<double>(found.y.v) / expected[1] - 1),
                         std::abs(static_cast<double>(found.z.v) / expected[2] - 1)});
      };
      errors[i] = error(specular_light(view, lanes, F(roughness)));
      diffuse[i] = roughness == 1 ? error(diffuse_light(view, lanes)) : 0;
    });
    std::printf("  roughness %.2f:", static_cast<double>(roughness));
    for (const int begin : {0, count}) {
      double most = 0, squares = 0;
      for (int i = begin; i < begin + count; ++i) {
        const double e = errors[static_cast<std::size_t>(i)];
        most = std::max(most, e), squares += e * e / count;
      }
      std::printf(" %s at most %.3f %%, RMS %.3f %%;", begin == 0 ? "random" : "near the brightest", 100 * most,
                  100 * std::sqrt(squares));
    }
    const double irradiance = *std::max_element(diffuse.begin(), diffuse.end());
    if (roughness == 1) std::printf(" irradiance %.3f %%", 100 * irradiance);
    std::printf("\n");
    greatest.push_back(std::max(*std::max_element(errors.begin(), errors.end()), irradiance));
  }
  return greatest;
}

TexelImage with_one_bright_pixel(int width) {
  Plane<float4> image(width, width / 2, {1, 1, 1, 1});
  image(width * 5 / 8 + 1, width / 8) = {8000, 8000, 8000, 1};
  return TexelImage(std::move(image));
}

/// The tables of docs/environment.md; it takes minutes.
TEST(EnvironmentError, DISABLED_OfPhotographsAndSuns) {
  const std::vector<float> all = {0,    0.03f, 0.05f, 0.07f, 0.1f, 0.15f, 0.2f, 0.3f,
                                  0.4f, 0.5f,  0.6f,  0.7f,  0.8f, 0.9f,  1};
  const std::vector<float> wide = {0.05f, 0.07f, 0.1f, 0.15f, 0.2f, 0.25f, 0.3f, 0.4f, 0.5f, 0.7f, 1};
  const auto expect_at_most = [](double bound, float least, const std::vector<float>& roughnesses,
                                 const std::vector<double>& errors) {
    for (std::size_t i = 0; i < errors.size(); ++i)
      EXPECT_TRUE(roughnesses[i] < least || errors[i] < bound) << roughnesses[i] << ": " << errors[i];
  };
  // From a roughness of `least` on, the maps resolve the lobes beside the brightest texel.
  const auto measure_spline = [&](const std::string& name, const CubeImage& cube, float least) {
    const PreparedEnvironment environment(cube);
    std::printf("%s: faces of %d, %.1f MB\n", name.c_str(), cube.side,
                static_cast<double>(environment.bytes().size()) / 1e6);
    const EnvironmentView view = environment.view({.color = {1, 1, 1}}, {0, 1, 0});
    expect_at_most(0.005, least, all, print_errors(" to the light at roughness 0", view, SplineRadiance(cube), all));
  };
  const auto measure = [&](const std::string& name, const TexelImage& image, float least = 0.1f,
                           float min_of_image = 0.1f) {
    CubeImage cube = cube_of_equirectangular(image, cube_side(image.width()));
    const PreparedEnvironment environment(cube);
    // Without its source the cube map is the spline, wider than the image, that a mirror reflects.
    cube.source.clear();
    measure_spline(name, cube, least);
    const EnvironmentView view = environment.view({.color = {1, 1, 1}}, {0, 1, 0});
    expect_at_most(0.005, min_of_image, wide, print_errors(" to the image", view, ImageRadiance(image), wide));
  };
  measure_spline("studio", studio_cube(64), 0.1f);
  for (const std::string& path : shared_files_ending("data/env", {".hdr"})) {
    const FileBytes file(path);
    const TexelImage image = decode_image(file.bytes(), path, 1u << 30).texels;
    // royal_esplanade_256.hdr has lamps of one pixel.
    const std::string name = path.substr(path.rfind('/') + 1);
    measure(name, image, 0.1f, name.starts_with("royal") ? 0.15f : 0.1f);
  }
  for (const int width : {64, 256, 1024}) {
    const TexelImage image = with_one_bright_pixel(width);
    measure("one pixel 8000 times brighter, width " + std::to_string(width), image, width < 256 ? 0.15f : 0.1f,
            width < 256   ? 0.2f
            : width < 512 ? 0.15f
                          : 0.1f);
  }
}

}  // namespace
}  // namespace zoneplate
