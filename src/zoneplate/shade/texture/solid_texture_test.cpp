// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/solid_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/solid_texture.h"

namespace zoneplate {
namespace {

constexpr SolidPattern patterns[] = {SolidPattern::Noise, SolidPattern::Turbulence, SolidPattern::Marble,
                                     SolidPattern::Wood, SolidPattern::Rock};

/// Fragments with the arrays of a batch.
struct Positions {
  static constexpr int count = 64;
  alignas(64) float position[3][count + 16] = {}, dx[3][count + 16] = {}, dy[3][count + 16] = {},
                                        out[3][count + 16] = {};

  void evaluate(const SolidTexture& texture, const SolidTextureKernels& kernels) {
    const SolidPoints points{{position[0], position[1], position[2]}, {dx[0], dx[1], dx[2]}, {dy[0], dy[1], dy[2]}};
    float* const colors[3] = {out[0], out[1], out[2]};
    kernels.evaluate(texture, points, colors, count);
  }
};

Positions random_positions(float footprint) {
  Positions points;
  for (std::uint32_t i = 0; i < Positions::count; ++i)
    for (std::uint32_t c = 0; c < 3; ++c) {
      points.position[c][i] = 10 * (unit_float(hash(i, c)) - 0.5f);
      points.dx[c][i] = footprint * (unit_float(hash(i, c, 1)) - 0.5f);
      points.dy[c][i] = footprint * (unit_float(hash(i, c, 2)) - 0.5f);
    }
  return points;
}

TEST(SolidTexture, AllInstructionSetsEvaluateTheSameBits) {
  for (const SolidPattern pattern : patterns) {
    const SolidTexture texture{.pattern = pattern, .scale = 1.7f, .low = {0.1f, 0.2f, 0.3f}, .high = {0.9f, 0.4f, 1}};
    for (const float footprint : {0.0f, 0.05f, 0.4f, 3.0f}) {
      Positions expected = random_positions(footprint);
      expected.position[0][3] = std::numeric_limits<float>::infinity();
      expected.position[1][5] = 1e30f;
      const Positions input = expected;
      expected.evaluate(texture, SolidTextureKernels::scalar);
      for (const float(&channel)[Positions::count + 16] : expected.out)
        for (int i = 0; i < Positions::count; ++i) EXPECT_TRUE(channel[i] >= 0 && channel[i] <= 1) << channel[i];
      for (const Isa isa : supported_isas()) {
        Positions points = input;
        points.evaluate(texture, SolidTextureKernels::of(isa));
        for (int c = 0; c < 3; ++c)
          EXPECT_EQ(std::memcmp(points.out[c], expected.out[c], sizeof(float) * Positions::count), 0) << name_of(isa);
      }
    }
  }
}

/// The mean of the unfiltered pattern over a square pixel around `position`, along x and z of object space.
double mean_over_pixel(const SolidTexture& texture, const float (&position)[3], float size) {
  constexpr int n = 64;
  double sum = 0;
  for (int row = 0; row < n; ++row) {
    Positions points;
    for (int i = 0; i < n; ++i) {
      points.position[0][i] = position[0] + size * ((static_cast<float>(i) + 0.5f) / n - 0.5f);
      points.position[1][i] = position[1];
      points.position[2][i] = position[2] + size * ((static_cast<float>(row) + 0.5f) / n - 0.5f);
    }
    points.evaluate(texture, SolidTextureKernels::scalar);
    for (int i = 0; i < n; ++i) sum += static_cast<double>(points.out[0][i]);
  }
  return sum / (n * n);
}

TEST(SolidTexture, FilteringEqualsTheMeanOverThePixel) {
  // Root mean square over points, and the same error without a filter. Undistorted veins are waves along one axis, for
  // which the filter is exact.
  const auto error_of = [](const SolidTexture& texture, float size, bool is_filtered) {
    Positions points = random_positions(0);
    for (int i = 0; i < Positions::count; ++i)
      if (is_filtered) points.dx[0][i] = size, points.dy[2][i] = size;
    points.evaluate(texture, SolidTextureKernels::scalar);
    double squares = 0;
    for (int i = 0; i < Positions::count; ++i) {
      const float position[3] = {points.position[0][i], points.position[1][i], points.position[2][i]};
      const double difference = static_cast<double>(points.out[0][i]) - mean_over_pixel(texture, position, size);
      squares += difference * difference;
    }
    return std::sqrt(squares / Positions::count);
  };
  for (const float size : {0.3f, 0.9f, 2.0f})
    EXPECT_LT(error_of({.pattern = SolidPattern::Marble, .distortion = 0}, size, true), 1e-3);
  for (const SolidPattern pattern : patterns)
    for (const float size : {0.5f, 1.5f}) {
      const SolidTexture texture{.pattern = pattern, .octaves = 4};
      const double filtered = error_of(texture, size, true), point_sampled = error_of(texture, size, false);
      EXPECT_LT(filtered, 0.6 * point_sampled) << static_cast<int>(pattern) << " " << size;
      EXPECT_LT(filtered, 0.12) << static_cast<int>(pattern) << " " << size;
    }
}

}  // namespace
}  // namespace zoneplate
