// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/texel_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "zoneplate/scene/texel_image.h"
#include "zoneplate/shade/environment/cube.h"
#include "zoneplate/shade/environment/equirectangular.h"

namespace zoneplate {
namespace {

constexpr double pi = std::numbers::pi;

/// The power of the light above 1, and its mean direction.
struct Excess {
  double power = 0;
  float3 direction{0, 0, 0};
};
Excess excess_of(const CubeImage& cube) {
  Excess out;
  for (int face = 0; face < cube::faces; ++face)
    for (int y = 0; y < cube.side; ++y)
      for (int x = 0; x < cube.side; ++x) {
        const float3 p = cube::point(face, cube::centre(x, cube.side), cube::centre(y, cube.side));
        const double square = dot(p, p), solid_angle = 4.0 / (cube.side * cube.side) / (square * std::sqrt(square));
        const double power = (static_cast<double>(cube.texels[cube.index(face, x, y)].y) - 1) * solid_angle;
        out.power += power;
        out.direction = out.direction + normalize(p) * static_cast<float>(power);
      }
  out.direction = normalize(out.direction);
  return out;
}

TEST(CubeOfEquirectangular, KeepsThePowerAndThePlaceOfALampOfOnePixel) {
  constexpr int width = 256, height = 128, side = 64;
  // Pixels are narrower than texels: 0.025 and, in the middle of a face, 0.031 radians.
  for (const int x : {13, 70, 71, 72, 73, 150, 201, 254})
    for (const int y : {27, 51, 64, 90}) {
      Plane<float4> image(width, height, {1, 1, 1, 1});
      image(x, y) = {8001, 8001, 8001, 1};
      const double u = (x + 0.5) / width * 2 * pi, v = (y + 0.5) / height * pi;
      const float3 expected{static_cast<float>(-std::cos(u) * std::sin(v)), static_cast<float>(std::cos(v)),
                            static_cast<float>(-std::sin(u) * std::sin(v))};
      const Excess found = excess_of(cube_of_equirectangular(TexelImage(image), side));
      EXPECT_NEAR(found.power / (8000 * (2 * pi / width) * (pi / height) * std::sin(v)), 1, 0.01) << x << ' ' << y;
      const float3 away = found.direction - expected;
      EXPECT_LT(std::sqrt(dot(away, away)), 0.0016f) << x << ' ' << y;  // a twentieth of a texel
    }
}

TEST(CubeOfTexels, LightThatIsEvenInEachTexelStays) {
  constexpr int side = 8;
  std::vector<TexelLight> texels(cube::faces * side * side);
  for (int i = 0; i < cube::faces * side * side; ++i) {
    const auto light = static_cast<float>(i % 7);
    TexelLight& texel = texels[static_cast<std::size_t>(i)];
    // Four directions of a texel, none in its middle.
    for (const float place : {0.1f, 0.2f, 0.3f, 0.7f})
      texel.add({light, 2 * light, 0}, 0.5f, place - 0.5f, 0.5f - place);
  }
  const CubeImage cube = cube_of_texels(side, texels);
  for (int i = 0; i < cube::faces * side * side; ++i) {
    EXPECT_NEAR(cube.texels[static_cast<std::size_t>(i)].x, static_cast<float>(i % 7), 1e-4f) << i;
    EXPECT_NEAR(cube.texels[static_cast<std::size_t>(i)].y, static_cast<float>(i % 7 * 2), 1e-4f) << i;
  }
}

}  // namespace
}  // namespace zoneplate
